#include <gtest/gtest.h>

#include <cmath>
#include <numbers>

#include "made_clouds.h"
#include "pcednet/core/random.h"
#include "pcednet/lines/curves/curve.h"

namespace pcednet::lines {
namespace {

constexpr double kWidth = 15.0, kLongSide = 40.0;  // of each side, in spacings
constexpr double kQuarterTurn = 0.5 * std::numbers::pi;

/// A measured sheet, bent at a right angle with `radius`, in spacings, about y: the points nearest
/// to the middle of the bend are labelled sharp-edge.
Cloud bent_sheet(double radius, double noise) {
  Random random(7);
  const double arc = kQuarterTurn * radius, middle = kWidth + 0.5 * arc, width = middle + middle;
  Cloud cloud{.spacing = 1.0};
  for (double i = 0.0; i < kLongSide * width; ++i) {
    const double across = width * random.uniform(), y = kLongSide * random.uniform();
    const double angle =
        across < kWidth ? 0.0 : std::min(kQuarterTurn, (across - kWidth) / std::max(radius, 1e-9));
    const Vec3 normal(std::sin(angle), 0.0, std::cos(angle));
    const Vec3 before(std::min(across, kWidth) - kWidth, y, -radius);
    const Vec3 after(0.0, 0.0, -std::max(0.0, across - kWidth - arc));
    const Vec3 at = before + radius * normal + after + noise * random.normal() * normal;
    cloud.add(at, normal, std::abs(across - middle) < 2.0);
  }
  return cloud;
}

double length_of_class(const std::vector<Curve>& curves, EdgeClass edge_class) {
  double length = 0.0;
  for (const Curve& curve : curves)
    length += curve.edge_class == edge_class ? length_of(curve) : 0.0;
  return length;
}

TEST(RoundedEdge, OfMeasuredPointsIsSmoothWhateverItsLabels) {
  for (const double noise : {0.02, 0.05, 0.1}) {
    const auto curves = lines_of(bent_sheet(6.0, noise));
    EXPECT_LT(length_of_class(curves, kSharpEdge), 0.15 * kLongSide) << noise;
    EXPECT_GT(length_of_class(curves, kSmoothEdge), 0.6 * kLongSide) << noise;
  }
}

TEST(RoundedEdge, OfAFractionOfASpacingIsSharp) {
  for (const double radius : {0.0, 0.5}) {
    for (const double noise : {0.02, 0.05, 0.1}) {
      const auto curves = lines_of(bent_sheet(radius, noise));
      EXPECT_NEAR(length_of_class(curves, kSharpEdge), kLongSide, 2.0) << radius << ' ' << noise;
      EXPECT_EQ(length_of_class(curves, kSmoothEdge), 0.0) << radius << ' ' << noise;
    }
  }
}

}  // namespace
}  // namespace pcednet::lines
