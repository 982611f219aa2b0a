#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <numbers>

#include "pcednet/core/random_vectors.h"
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
      const Vec3 noise = normal_vector(random);
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

constexpr double kThick = 2.5;

/// The end of a wall, along y: both sides and, at x = 0, the rim
/// between its two edges. Of mixed signs, normals do not tell the sides apart.
std::vector<Curve> lines_of_wall(std::uint64_t seed, bool mixed_signs) {
  constexpr double kDeep = 30.0;
  Random random(seed);
  std::vector<Vec3> positions, normals;
  std::vector<std::uint8_t> classes;
  for (int i = 0; i < static_cast<int>((2.0 * kDeep + kThick) * kRidgeLength); ++i) {
    const double across = (2.0 * kDeep + kThick) * random.uniform() - kDeep;
    const double beside = across < 0.0 ? across : std::min(0.0, kThick - across);
    const Vec3 place(beside, kRidgeLength * random.uniform(), std::clamp(across, 0.0, kThick));
    const Vec3 normal = beside == 0.0  ? Vec3(Vec3::UnitX())
                        : across < 0.0 ? Vec3(-Vec3::UnitZ())
                                       : Vec3(Vec3::UnitZ());
    const Vec3 noise = normal_vector(random);
    positions.push_back(place + kRidgeNoise * noise);
    normals.push_back(mixed_signs && random.uniform() < 0.5 ? Vec3(-normal) : normal);
    classes.push_back(beside > -1.5 ? kSharpEdge : kNonEdge);
  }
  return find_lines({positions, normals, classes});
}

/// The length of the curves along one of its edges.
double length_on_wall(const std::vector<Curve>& curves) {
  double length = 0.0;
  for (const Curve& curve : curves) {
    for (const double z : {0.0, kThick}) {
      const bool on_edge =
          std::all_of(curve.points.begin(), curve.points.end(),
                      [&](const Vec3& p) { return std::hypot(p.x(), p.z() - z) < 1.0; });
      if (on_edge) length += length_of(curve);
    }
  }
  return length;
}

TEST(NoisyWall, HasTwoEdgesWhateverTheSignsOfItsNormals) {
  double length = 0.0, mixed = 0.0;
  for (const std::uint64_t seed : {1u, 2u, 3u, 4u}) {
    length += length_on_wall(lines_of_wall(seed, false));
    mixed += length_on_wall(lines_of_wall(seed, true));
  }
  EXPECT_GT(length, 0.9 * 8.0 * kRidgeLength);
  EXPECT_GT(mixed, 0.9 * 8.0 * kRidgeLength);
}

/// A roof's ridge along y, noisy, with a hole of five spacings across it; the points near it are
/// edges with a probability of .85.
std::vector<Curve> lines_of_ridge_with_hole(std::uint64_t seed, double gap) {
  Random random(seed);
  std::vector<Vec3> positions, normals;
  std::vector<std::uint8_t> classes;
  std::vector<float> probable;
  for (int i = 0; i < static_cast<int>(60.0 * kRidgeLength); ++i) {
    const double across = 60.0 * (random.uniform() - 0.5), y = kRidgeLength * random.uniform();
    const Vec3 noise = normal_vector(random);
    if (std::abs(y - 0.5 * kRidgeLength) < 2.5) continue;
    const Vec3 place(across, y, -std::abs(across));
    positions.push_back(Vec3(std::sqrt(0.5), 1.0, std::sqrt(0.5)).cwiseProduct(place) +
                        kRidgeNoise * noise);
    normals.push_back(Vec3(std::copysign(1.0, across), 0.0, 1.0).normalized());
    classes.push_back(std::abs(across) < 1.5 ? kSharpEdge : kNonEdge);
    probable.push_back(std::abs(across) < 1.5 ? 0.85f : 0.01f);
  }
  return find_lines({positions, normals, classes, probable}, {.gap = gap});
}

TEST(NoisyRidge, IsDrawnWithAnyGapAcrossAHole) {
  for (const std::uint64_t seed : {1u, 2u, 3u}) {
    for (const double gap : {2.0, 3.0, 3.5, 4.0, 4.5, 5.0, 5.5, 6.0, 7.0}) {
      double length = 0.0;
      for (const Curve& curve : lines_of_ridge_with_hole(seed, gap)) length += length_of(curve);
      EXPECT_GT(length, 0.85 * kRidgeLength) << seed << " " << gap;
      EXPECT_LT(length, 1.05 * kRidgeLength) << seed << " " << gap;
    }
  }
}

}  // namespace
}  // namespace pcednet::lines
