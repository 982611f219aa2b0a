#include "pcednet/lines/curves/curve.h"

#include <gtest/gtest.h>

#include <cmath>
#include <numbers>

namespace pcednet::lines {
namespace {

constexpr double kPi = std::numbers::pi;

Curve arc(double radius, double angle) {
  Curve curve{.kind = CurveKind::kArc};
  curve.centre = {1.0, 2.0, 3.0};
  curve.radius = radius;
  const Vec3 x = radius * Vec3::UnitX(), y = radius * Vec3::UnitY();
  curve.points = {curve.centre + x, curve.centre + std::cos(angle) * x + std::sin(angle) * y};
  return curve;
}

Curve circle(double radius) {
  Curve curve = arc(radius, kPi);
  curve.kind = CurveKind::kCircle;
  curve.closed = true;
  curve.points.pop_back();
  return curve;
}

TEST(Curve, AnglesOfArcsGoAboutTheAxis) {
  EXPECT_NEAR(angle_of(arc(2.0, 0.5)), 0.5, 1e-12);
  EXPECT_NEAR(angle_of(arc(2.0, 1.5 * kPi)), 1.5 * kPi, 1e-12);
  Curve turned = arc(2.0, 0.5);
  turned.axis = -turned.axis;
  EXPECT_NEAR(angle_of(turned), 2.0 * kPi - 0.5, 1e-12);
}

TEST(Curve, LengthsAreExact) {
  EXPECT_NEAR(length_of(arc(2.0, 0.5)), 1.0, 1e-12);
  EXPECT_NEAR(length_of(circle(3.0)), 6.0 * kPi, 1e-12);
  Curve square{.points = {{0, 0, 0}, {1, 0, 0}, {1, 1, 0}, {0, 1, 0}}};
  EXPECT_DOUBLE_EQ(length_of(square), 3.0);
  square.closed = true;
  EXPECT_DOUBLE_EQ(length_of(square), 4.0);
}

TEST(Curve, SamplesStayWithinTheTolerance) {
  for (const Curve& curve : {arc(2.0, 0.5), arc(0.1, 6.0), circle(3.0), circle(0.001)}) {
    const double tolerance = 0.01;
    const auto vertices = sampled(curve, tolerance);
    EXPECT_EQ(vertices.front(), curve.points.front());
    EXPECT_EQ(vertices.back(), curve.points.back());
    for (std::size_t i = 0; i < vertices.size(); ++i) {
      EXPECT_NEAR((vertices[i] - curve.centre).norm(), curve.radius, 1e-12);
      if (i == 0) continue;
      const Vec3 middle = 0.5 * (vertices[i] + vertices[i - 1]);
      EXPECT_LE(curve.radius - (middle - curve.centre).norm(), tolerance);
    }
  }
}

TEST(Curve, SamplesOfACircleAre4096AtMost) {
  const auto vertices = sampled(circle(3.0), 1e-12);
  ASSERT_EQ(vertices.size(), 4097u);
  const Vec3 middle = 0.5 * (vertices[0] + vertices[1]);
  EXPECT_LE(3.0 - middle.norm(), 3e-7 * 3.0);
}

TEST(Curve, SamplesOfAClosedPolylineEndWhereTheyBegin) {
  const Curve triangle{.points = {{0, 0, 0}, {1, 0, 0}, {1, 1, 0}}, .closed = true};
  const auto vertices = sampled(triangle, 0.1);
  ASSERT_EQ(vertices.size(), 4u);
  EXPECT_EQ(vertices.front(), vertices.back());
}

}  // namespace
}  // namespace pcednet::lines
