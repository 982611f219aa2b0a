#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <numbers>

#include "pcednet/core/random.h"
#include "pcednet/lines/find_lines.h"

namespace pcednet::lines {
namespace {

constexpr double kRidgeLength = 80.0, kRidgeNoise = 0.4;

/// A ridge along y with a flat top of three spacings and sides at 60 degrees, one point per unit of
/// area seen from above; points labelled within 1.5 of its edges.
struct Ridge {
  static constexpr double kHalfTop = 1.5;
  std::vector<Vec3> positions = {}, normals = {};
  std::vector<std::uint8_t> classes = {};

  explicit Ridge(std::uint64_t seed) {
    Random random(seed);
    const double slope = std::tan(std::numbers::pi / 3.0);
    for (int i = 0; i < static_cast<int>(kRidgeLength * kRidgeLength); ++i) {
      const double x = kRidgeLength * (random.uniform() - 0.5), y = kRidgeLength * random.uniform();
      const double beyond = std::max(0.0, std::abs(x) - kHalfTop);
      const Vec3 noise(random.normal(), random.normal(), random.normal());
      positions.push_back(Vec3(x, y, -slope * beyond) + kRidgeNoise * noise);
      normals.push_back(beyond == 0.0 ? Vec3(0.0, 0.0, 1.0)
                                      : Vec3(std::copysign(slope, x), 0.0, 1.0).normalized());
      classes.push_back(std::abs(std::abs(x) - kHalfTop) < 1.5 ? kSharpEdge : kNonEdge);
    }
  }
};

/// The length of the curves that run along one of both edges.
double length_on_edges(const std::vector<Curve>& curves) {
  double length = 0.0;
  for (const Curve& curve : curves) {
    const bool on_edge = std::all_of(curve.points.begin(), curve.points.end(), [](const Vec3& p) {
      return std::hypot(std::abs(p.x()) - Ridge::kHalfTop, p.z()) < 1.2;
    });
    if (on_edge) length += length_of(curve);
  }
  return length;
}

TEST(NoisyRidge, ShowsEdgesThatAreThreeSpacingsApart) {
  double length = 0.0;
  for (const std::uint64_t seed : {1u, 2u, 3u, 4u}) {
    const Ridge ridge(seed);
    length += length_on_edges(find_lines({ridge.positions, ridge.normals, ridge.classes}));
  }
  EXPECT_GT(length, 0.4 * 8.0 * kRidgeLength);  // without points along the edge it is 0.26
}

}  // namespace
}  // namespace pcednet::lines
