#include "pcednet/lines/creases/noisy_wedge.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <numbers>
#include <vector>

#include "pcednet/core/random.h"

namespace pcednet::lines {
namespace {

constexpr double kNoise = 0.5, kLittleNoise = 0.05;
constexpr std::size_t kPoints = 72;

/// One point per unit of area over the disc that holds `kPoints`, at the height of a surface, with
/// noise in all directions; nearest first.
template <typename Height>
NearPoints noisy_points(std::uint64_t seed, const Height& height, double noise = kNoise) {
  Random random(seed);
  const double reach = std::sqrt(static_cast<double>(kPoints) / std::numbers::pi);
  std::vector<Vec3> places;
  while (places.size() < kPoints) {
    const double u = reach * (2.0 * random.uniform() - 1.0);
    const double v = reach * (2.0 * random.uniform() - 1.0);
    if (u * u + v * v > reach * reach) continue;
    places.push_back(Vec3(u, v, height(u)) +
                     noise * Vec3{random.normal(), random.normal(), random.normal()});
  }
  std::sort(places.begin(), places.end(),
            [](const Vec3& a, const Vec3& b) { return a.squaredNorm() < b.squaredNorm(); });
  NearPoints points;
  for (const Vec3& place : places) points.add(place, Vec3::Zero(), 1.0);
  return points;
}

TEST(NoisyWedge, FindsAnEdgeOfSixtyDegreesInNoiseOfHalfASpacing) {
  const double slope = std::tan(30.0 * std::numbers::pi / 180.0);
  int found = 0;
  for (std::uint64_t seed = 0; seed < 50; ++seed) {
    const auto points = noisy_points(seed, [&](double u) { return -slope * std::abs(u); });
    const auto halves = fit_half_planes(points, kPoints, kNoise);
    if (!halves) continue;
    const double away = std::hypot(halves->at.x(), halves->at.z());
    found += away < 1.0 && std::abs(halves->along.y()) > 0.95;
    EXPECT_NEAR(halves->at.dot(halves->along), 0.0, 1e-9);
    EXPECT_LT(halves->side_a.x() * halves->side_b.x(), 0.0);
    for (const Vec3& side : {halves->side_a, halves->side_b}) {
      EXPECT_NEAR(side.norm(), 1.0, 1e-9);
      EXPECT_NEAR(side.dot(halves->along), 0.0, 1e-9);
    }
  }
  EXPECT_GE(found, 30);
}

TEST(NoisyWedge, FindsNoneOnAPlane) {
  int found = 0;
  for (std::uint64_t seed = 0; seed < 50; ++seed) {
    const auto points = noisy_points(seed, [](double) { return 0.0; });
    found += fit_half_planes(points, kPoints, kNoise).has_value();
  }
  EXPECT_LE(found, 5);
}

TEST(NoisyWedge, FindsFewOnACylinder) {
  constexpr double kRadius = 8.0;
  int found = 0;
  for (std::uint64_t seed = 0; seed < 50; ++seed) {
    const auto points =
        noisy_points(seed, [](double u) { return std::sqrt(kRadius * kRadius - u * u) - kRadius; });
    found += fit_half_planes(points, kPoints, kNoise).has_value();
  }
  EXPECT_LE(found, 15);
}

/// Half-planes that fall by as much as they go away from the line x = z = 0.
const Wedge kRightAngle = {Vec3::Zero(), Vec3::UnitY(), Vec3(1, 0, -1).normalized(),
                           Vec3(-1, 0, -1).normalized()};

TEST(NoisyWedge, IsNoSmoothSurface) {
  for (std::uint64_t seed = 0; seed < 50; ++seed) {
    const auto points = noisy_points(
        seed, [](double u) { return -std::abs(u); }, kLittleNoise);
    EXPECT_FALSE(is_smooth(points, kRightAngle, kLittleNoise)) << seed;
  }
}

TEST(NoisyWedge, ExplainsACylinderLessThanASmoothSurface) {
  constexpr double kRadius = 8.0;
  for (std::uint64_t seed = 0; seed < 50; ++seed) {
    const auto points = noisy_points(
        seed, [](double u) { return std::sqrt(kRadius * kRadius - u * u) - kRadius; },
        kLittleNoise);
    EXPECT_TRUE(is_smooth(points, kRightAngle, kLittleNoise)) << seed;
  }
}

TEST(NoisyWedge, DependsOnNoLastDigit) {
  constexpr std::size_t kFew = 28;  // cuts in several directions make the same parts
  for (std::uint64_t seed = 0; seed < 3000; ++seed) {
    const auto points = noisy_points(seed, [](double u) { return -std::abs(u); });
    NearPoints rounded;
    for (std::size_t i = 0; i < kFew; ++i) {
      rounded.add(points.offset(i) / 3.0 * 3.0, Vec3::Zero(), 1.0);
    }
    const auto found = fit_half_planes(points, kFew, kNoise);
    const auto again = fit_half_planes(rounded, kFew, kNoise);
    ASSERT_EQ(found.has_value(), again.has_value()) << seed;
    if (!found) continue;
    ASSERT_LT((found->at - again->at).norm(), 1e-6) << seed;
  }
}

TEST(NoisyWedge, NeedsPoints) {
  const auto points = noisy_points(1, [](double u) { return -std::abs(u); });
  EXPECT_FALSE(fit_half_planes(points, 13, kNoise));
  EXPECT_FALSE(fit_half_planes({}, kPoints, kNoise));
}

}  // namespace
}  // namespace pcednet::lines
