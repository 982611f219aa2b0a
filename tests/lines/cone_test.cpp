#include <gtest/gtest.h>

#include <Eigen/Geometry>
#include <cmath>
#include <numbers>
#include <vector>

#include "lines/made_clouds.h"
#include "pcednet/core/random_vectors.h"
#include "pcednet/lines/find_lines.h"

namespace pcednet::lines {
namespace {

/// A cone on a disc of radius 1, with points labelled along the rim and around the apex.
Cloud cone(std::size_t points, double half_angle, std::uint64_t seed) {
  Random random(seed);
  const double sine = std::sin(half_angle), height = 1.0 / std::tan(half_angle);
  const double on_base = sine / (1.0 + sine);
  Cloud cloud{.spacing =
                  std::sqrt(std::numbers::pi * (1.0 + 1.0 / sine) / static_cast<double>(points))};
  for (std::size_t i = 0; i < points; ++i) {
    const double angle = 2.0 * std::numbers::pi * random.uniform();
    const double radius = std::sqrt(random.uniform());
    const Vec3 outward(std::cos(angle), std::sin(angle), 0.0);
    const bool is_on_base = random.uniform() < on_base;
    const Vec3 normal = is_on_base ? Vec3(-Vec3::UnitZ())
                                   : Vec3(std::cos(half_angle) * outward + sine * Vec3::UnitZ());
    const double up = is_on_base ? 0.0 : height * (1.0 - radius);
    const double from_rim = (1.0 - radius) / (is_on_base ? 1.0 : sine);
    const bool is_at_apex = !is_on_base && radius / sine < 8.0 * cloud.spacing;
    cloud.add(radius * outward + up * Vec3::UnitZ(), normal,
              from_rim < kNear * cloud.spacing || is_at_apex);
  }
  return cloud;
}

std::vector<Curve> lines_of_cone(double degrees, std::uint64_t seed, std::uint8_t label) {
  Cloud cloud = cone(6000, degrees * std::numbers::pi / 180.0, seed);
  const Eigen::AngleAxisd turn(0.7, Vec3(1.0, 2.0, 3.0).normalized());
  for (std::size_t i = 0; i < cloud.classes.size(); ++i) {
    if (cloud.classes[i] == kSharpEdge) cloud.classes[i] = label;
    cloud.positions[i] = turn * cloud.positions[i];
    cloud.normals[i] = turn * cloud.normals[i];
  }
  return find_lines({cloud.positions, cloud.normals, cloud.classes}, {});
}

/// However the points are labelled: planes that meet at such angles are not rounded.
TEST(LinesOfACone, AreItsRimAlone) {
  for (const double degrees : {20.0, 30.0, 40.0, 50.0}) {
    for (const std::uint8_t label : {kSharpEdge, kSmoothEdge}) {
      const std::vector<Curve> curves = lines_of_cone(degrees, 5, label);
      ASSERT_EQ(curves.size(), 1u) << degrees;
      EXPECT_EQ(curves[0].kind, CurveKind::kCircle) << degrees;
      EXPECT_NEAR(curves[0].radius, 1.0, 1e-3) << degrees;
      EXPECT_EQ(curves[0].edge_class, kSharpEdge) << degrees;
    }
  }
}

}  // namespace
}  // namespace pcednet::lines
