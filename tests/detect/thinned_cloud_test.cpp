#include "pcednet/detect/thinned_cloud.h"

#include <gtest/gtest.h>

#include <cmath>
#include <limits>
#include <numeric>
#include <vector>

#include "pcednet/core/median.h"
#include "pcednet/core/parallel.h"
#include "pcednet/core/random.h"
#include "pcednet/core/random_vectors.h"
#include "pcednet/spatial/curve_order.h"

namespace pcednet::detect {
namespace {

constexpr double kSpacing = 0.05;

/// A roof of two slopes over a square of 12 x 12, a point per kSpacing^2, with noise in spacings.
struct Roof {
  static constexpr double kSlope = 0.7;
  std::vector<Vec3> positions;

  explicit Roof(double noise) {
    const double area = 144.0 * std::sqrt(1.0 + kSlope * kSlope);
    Random random(5);
    for (int i = 0; i < static_cast<int>(area / (kSpacing * kSpacing)); ++i) {
      const double x = random.uniform(-6.0, 6.0), y = random.uniform(-6.0, 6.0);
      positions.push_back(Vec3(x, y, -kSlope * std::abs(x)) +
                          noise * kSpacing * normal_vector(random));
    }
  }
  static double height(const Vec3& p) {
    return (p.z() + kSlope * std::abs(p.x())) / std::sqrt(1.0 + kSlope * kSlope);
  }
};

std::optional<ThickNoise> noise_of(const std::vector<Vec3>& positions) {
  return find_thick_noise(positions, spatial::curve_order(positions));
}

/// The median distance from the surface, of points farther than 8 spacings from edges.
double roughness(const std::vector<Vec3>& positions) {
  std::vector<double> heights;
  for (const Vec3& p : positions) {
    const double inside = std::min({std::abs(p.x()), 6.0 - std::abs(p.x()), 6.0 - std::abs(p.y())});
    if (inside > 8.0 * kSpacing) heights.push_back(std::abs(Roof::height(p)));
  }
  return median(std::move(heights));
}

TEST(ThickNoise, IsMeasured) {
  for (const double noise : {1.1, 2.0, 3.0}) {
    const auto found = noise_of(Roof(noise).positions);
    ASSERT_TRUE(found) << noise;
    EXPECT_NEAR(found->deviation, noise * kSpacing, 0.08 * noise * kSpacing) << noise;
    EXPECT_NEAR(found->spacing, kSpacing, 0.06 * kSpacing) << noise;
  }
}

TEST(ThickNoise, IsNotThinNoise) {
  for (const double noise : {0.0, 0.3, 0.7}) EXPECT_FALSE(noise_of(Roof(noise).positions)) << noise;
}

TEST(ThickNoise, IsNoFilledSpace) {
  Random random(6);
  std::vector<Vec3> leaves(40000);
  for (Vec3& p : leaves) p = uniform_vector(random, Vec3::Zero(), Vec3::Ones());
  EXPECT_FALSE(noise_of(leaves));
}

TEST(ThickNoise, IsNotTheTwoSidesOfAWall) {
  std::vector<Vec3> positions = Roof(0.4).positions;
  for (std::size_t i = 0; i < positions.size(); i += 2) positions[i].z() += 2.0 * kSpacing;
  EXPECT_FALSE(noise_of(positions));
}

TEST(ThickNoise, IsNotNoiseThatVaries) {
  Random random(7);
  std::vector<Vec3> positions = Roof(0.0).positions;
  for (Vec3& p : positions) {
    p += (p.y() > 0.0 ? 3.0 : 1.0) * kSpacing * normal_vector(random);
  }
  EXPECT_FALSE(noise_of(positions));
}

TEST(ThickNoise, IsNoneOfFewPoints) {
  EXPECT_FALSE(noise_of({}));
  EXPECT_FALSE(noise_of({Vec3::Zero()}));
  EXPECT_FALSE(noise_of(std::vector<Vec3>(1000, Vec3::Ones())));
}

TEST(ThinnedClouds, HaveTheSurfaceWithoutMostOfTheNoise) {
  const std::vector<Vec3> positions = Roof(2.0).positions;
  const auto thinned = thin_noise(positions);
  ASSERT_TRUE(thinned);
  EXPECT_LT(thinned->positions.size(), positions.size() / 4);
  EXPECT_GT(thinned->positions.size(), 4000u);
  EXPECT_NEAR(roughness(positions), 0.67 * 2.0 * kSpacing, 0.1 * kSpacing);
  ASSERT_EQ(thinned->of_points.size(), positions.size());
  double farthest = 0.0;
  std::vector<Vec3> own;
  for (std::size_t i = 0; i < positions.size(); ++i) {
    own.push_back(thinned->positions.at(thinned->of_points[i]));
    farthest = std::max(farthest, (own.back() - positions[i]).norm());
  }
  EXPECT_LT(roughness(own), 0.4 * kSpacing);
  EXPECT_LT(farthest, 15.0 * kSpacing);  // seven deviations
}

TEST(ThinnedClouds, AreNotOfThinNoiseNorOfSoFewThatHardlyAnyAreLeft) {
  EXPECT_FALSE(thin_noise(Roof(0.7).positions));
  std::vector<Vec3> few = Roof(2.0).positions;
  std::erase_if(few, [](const Vec3& p) { return std::abs(p.x()) > 3.0 || std::abs(p.y()) > 3.0; });
  EXPECT_TRUE(noise_of(few));
  EXPECT_FALSE(thin_noise(few));
}

TEST(ThinnedClouds, AreTheSameInAnyOrderAndForAnyThreads) {
  std::vector<Vec3> positions = Roof(2.0).positions;
  const auto first = thin_noise(positions);
  ASSERT_TRUE(first);
  std::vector<std::uint32_t> order(positions.size());
  std::iota(order.begin(), order.end(), 0u);
  Random random(8);
  random.shuffle(std::span(order));
  std::vector<Vec3> shuffled;
  for (const std::uint32_t i : order) shuffled.push_back(positions[i]);
  for (const int threads : {1, 2, 8}) {
    set_thread_count(threads);
    const auto other = thin_noise(shuffled);
    ASSERT_TRUE(other);
    ASSERT_EQ(other->positions, first->positions) << threads;
    for (std::size_t i = 0; i < order.size(); ++i) {
      ASSERT_EQ(other->of_points[i], first->of_points[order[i]]);
    }
  }
  set_thread_count(0);
}

TEST(ThinnedClouds, FollowTheCloudToANationalGrid) {
  std::vector<Vec3> positions = Roof(2.0).positions;
  const auto here = thin_noise(positions);
  const Vec3 origin(431000.0, 5412000.0, 90.0);
  for (Vec3& p : positions) p += origin;
  const auto there = thin_noise(positions);
  ASSERT_TRUE(here && there);
  EXPECT_NEAR(there->noise.deviation, here->noise.deviation, 1e-3 * kSpacing);
  std::size_t same = 0;
  for (std::size_t i = 0; i < positions.size(); ++i) {
    const Vec3& own = there->positions[there->of_points[i]];
    same += (own - origin - here->positions[here->of_points[i]]).norm() < 0.01 * kSpacing;
  }
  EXPECT_GT(static_cast<double>(same), 0.99 * static_cast<double>(positions.size()));
}

TEST(ThinnedClouds, LeaveOutPointsWithoutAPosition) {
  std::vector<Vec3> positions = Roof(2.0).positions;
  positions[7].y() = std::numeric_limits<double>::quiet_NaN();
  positions[8].x() = 1e30;
  const auto thinned = thin_noise(positions);
  ASSERT_TRUE(thinned);
  EXPECT_EQ(thinned->of_points[7], ThinnedCloud::kNone);
  EXPECT_NE(thinned->of_points[6], ThinnedCloud::kNone);
  Classification found;
  found.classes.assign(thinned->positions.size(), kSharpEdge);
  found.p_sharp.assign(thinned->positions.size(), 0.75f);
  const Classification all = found_for_all(found, *thinned);
  ASSERT_EQ(all.classes.size(), positions.size());
  EXPECT_EQ(all.classes[7], kUnlabelled);
  EXPECT_EQ(all.p_sharp[7], 0.0f);
  EXPECT_EQ(all.p_sharp[6], 0.75f);
  EXPECT_TRUE(all.p_smooth.empty());
  EXPECT_EQ(all.counts.sharp, positions.size() - 1);
  EXPECT_EQ(all.counts.unlabelled, 1u);
  const std::vector<Vec3> normals(thinned->positions.size(), Vec3::UnitZ());
  EXPECT_EQ(normals_for_all(normals, *thinned)[6], Vec3::UnitZ());
  EXPECT_EQ(normals_for_all(normals, *thinned)[7], Vec3::Zero());
}

TEST(ThinnedClouds, TakeTheLabelsOfMostOfTheirPoints) {
  ThinnedCloud thinned;
  thinned.positions.resize(3);
  thinned.of_points = {0, 0, 0, 1, 1, 2, ThinnedCloud::kNone};
  Classification found;
  found.classes = {kSharpEdge, kSharpEdge, kNonEdge, kUnlabelled, 9, kUnlabelled, kSharpEdge};
  found.p_sharp = {0.9f, 0.6f, 0.3f, 0.0f, 0.0f, 0.0f, 1.0f};
  const Classification fewer = found_for_thinned({found.classes, found.p_sharp}, thinned);
  EXPECT_EQ(fewer.classes, (std::vector<std::uint8_t>{kSharpEdge, kNonEdge, kUnlabelled}));
  ASSERT_EQ(fewer.p_sharp.size(), 3u);
  EXPECT_NEAR(fewer.p_sharp[0], 0.6f, 1e-6);
  EXPECT_TRUE(fewer.p_smooth.empty());
}

}  // namespace
}  // namespace pcednet::detect
