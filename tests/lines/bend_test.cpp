#include "pcednet/lines/creases/bend.h"

#include <gtest/gtest.h>

#include <cmath>
#include <numbers>

#include "pcednet/core/random.h"

namespace pcednet::lines {
namespace {

constexpr double kDegree = std::numbers::pi / 180.0;

/// Along z, with one side along x.
Wedge wedge_of(double degrees) {
  const double angle = degrees * kDegree;
  return {.at = Vec3::Zero(),
          .along = Vec3::UnitZ(),
          .side_a = Vec3::UnitX(),
          .side_b = {std::cos(angle), std::sin(angle), 0.0}};
}

/// 100 points beside the line of a wedge, whose corner is an arc of this radius.
NearPoints points_on(const Wedge& wedge, double degrees, double radius) {
  const double half = 0.5 * degrees * kDegree, tangent = radius / std::tan(half);
  const double turn = std::numbers::pi - 2.0 * half, arc = turn * radius;
  const Vec3 centre = tangent * wedge.side_a + radius * Vec3::UnitY();
  Random random(3);
  NearPoints points;
  for (int i = 0; i < 100; ++i) {
    const double along = random.uniform(-3.0, 3.0), at = random.uniform(-3.0, 3.0);
    Vec3 place = (tangent + std::abs(at) - 0.5 * arc) * (at < 0.0 ? wedge.side_b : wedge.side_a);
    if (std::abs(at) < 0.5 * arc) {
      const double angle = -0.5 * std::numbers::pi - 0.5 * turn + at / radius;
      place = centre + radius * Vec3(std::cos(angle), std::sin(angle), 0.0);
    }
    points.add(place + along * Vec3::UnitZ(), Vec3::Zero(), 0.0);
  }
  return points;
}

TEST(Bend, OfPlanesIsNoneAtAnyAngle) {
  for (const double degrees : {15.0, 30.0, 40.0, 50.0, 70.0, 90.0, 120.0, 150.0}) {
    const Wedge wedge = wedge_of(degrees);
    EXPECT_NEAR(bend_of(wedge, points_on(wedge, degrees, 0.0), 0.3), 0.0, 1e-9) << degrees;
  }
}

TEST(Bend, OfARoundedEdgeIsSeen) {
  const Wedge wedge = wedge_of(90.0);
  for (const double radius : {1.2, 1.5, 2.0}) {
    EXPECT_GT(bend_of(wedge, points_on(wedge, 90.0, radius), 0.3), 0.08) << radius;
  }
}

}  // namespace
}  // namespace pcednet::lines
