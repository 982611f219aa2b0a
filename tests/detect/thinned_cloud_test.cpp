#include "pcednet/detect/points/thinned_cloud.h"

#include <gtest/gtest.h>

#include <cmath>
#include <limits>
#include <numeric>
#include <vector>

#include "pcednet/core/median.h"
#include "pcednet/core/parallel.h"
#include "pcednet/core/random.h"
#include "pcednet/core/random_vectors.h"
#include "pcednet/detect/averages.h"
#include "pcednet/detect/result_cloud.h"
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

std::optional<ThinnedCloud> thinned_of(const std::vector<Vec3>& positions) {
  return thin_noise(positions, spatial::curve_order(positions));
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
  const auto thinned = thinned_of(positions);
  ASSERT_TRUE(thinned);
  EXPECT_LT(thinned->positions.size(), positions.size() / 4);
  EXPECT_GT(thinned->positions.size(), 4000u);
  EXPECT_NEAR(roughness(positions), 0.67 * 2.0 * kSpacing, 0.1 * kSpacing);
  ASSERT_EQ(thinned->average_of.size(), positions.size());
  double farthest = 0.0;
  std::vector<Vec3> own;
  for (std::size_t i = 0; i < positions.size(); ++i) {
    own.push_back(thinned->positions.at(thinned->average_of[i]));
    farthest = std::max(farthest, (own.back() - positions[i]).norm());
  }
  EXPECT_LT(roughness(own), 0.4 * kSpacing);
  EXPECT_LT(farthest, 15.0 * kSpacing);  // seven deviations
}

TEST(ThinnedClouds, AreNotOfThinNoiseNorOfSoFewThatHardlyAnyAreLeft) {
  EXPECT_FALSE(thinned_of(Roof(0.7).positions));
  std::vector<Vec3> few = Roof(2.0).positions;
  std::erase_if(few, [](const Vec3& p) { return std::abs(p.x()) > 3.0 || std::abs(p.y()) > 3.0; });
  EXPECT_TRUE(noise_of(few));
  EXPECT_FALSE(thinned_of(few));
}

TEST(ThinnedClouds, AreTheSameInAnyOrderAndForAnyThreads) {
  std::vector<Vec3> positions = Roof(2.0).positions;
  const auto first = thinned_of(positions);
  ASSERT_TRUE(first);
  std::vector<std::uint32_t> order(positions.size());
  std::iota(order.begin(), order.end(), 0u);
  Random random(8);
  random.shuffle(std::span(order));
  std::vector<Vec3> shuffled;
  for (const std::uint32_t i : order) shuffled.push_back(positions[i]);
  for (const int threads : {1, 2, 8}) {
    set_thread_count(threads);
    const auto other = thinned_of(shuffled);
    ASSERT_TRUE(other);
    ASSERT_EQ(other->positions, first->positions) << threads;
    for (std::size_t i = 0; i < order.size(); ++i) {
      ASSERT_EQ(other->average_of[i], first->average_of[order[i]]);
    }
  }
  set_thread_count(0);
}

TEST(ThinnedClouds, FollowTheCloudToANationalGrid) {
  std::vector<Vec3> positions = Roof(2.0).positions;
  const auto here = thinned_of(positions);
  const Vec3 origin(431000.0, 5412000.0, 90.0);
  for (Vec3& p : positions) p += origin;
  const auto there = thinned_of(positions);
  ASSERT_TRUE(here && there);
  EXPECT_NEAR(there->noise.deviation, here->noise.deviation, 1e-3 * kSpacing);
  std::size_t same = 0;
  for (std::size_t i = 0; i < positions.size(); ++i) {
    const Vec3& own = there->positions[there->average_of[i]];
    same += (own - origin - here->positions[here->average_of[i]]).norm() < 0.01 * kSpacing;
  }
  EXPECT_GT(static_cast<double>(same), 0.99 * static_cast<double>(positions.size()));
}

TEST(ThinnedClouds, HaveTheSamePointsInAPartOfTheCloud) {
  const std::vector<Vec3> positions = Roof(2.0).positions;
  const auto whole = thinned_of(positions);
  ASSERT_TRUE(whole);
  std::vector<std::uint32_t> part;  // y < 1, and what affects their averages
  std::vector<Vec3> its;
  const double reach = 2.0 * kAveragingReach * whole->averaging.deviation;
  for (std::uint32_t i = 0; i < positions.size(); ++i) {
    if (positions[i].y() > 1.0 + reach) continue;
    part.push_back(i);
    its.push_back(positions[i]);
  }
  const auto thinned = thin_as_decided(its, spatial::curve_order(its), whole->averaging);
  EXPECT_LT(thinned.positions.size(), 0.9 * static_cast<double>(whole->positions.size()));
  for (std::size_t k = 0; k < part.size(); ++k) {
    const Vec3& expected = whole->positions[whole->average_of[part[k]]];
    EXPECT_LT((its[k] - expected).cwiseAbs().maxCoeff(),
              kAveragingReach * whole->averaging.deviation);
    if (its[k].y() < 1.0) {
      EXPECT_LT((thinned.positions[thinned.average_of[k]] - expected).norm(), 1e-12);
    }
  }
}

TEST(Averages, AreClassifiedInPlaceOfTheirPoints) {
  PointCloud cloud;
  cloud.positions = Roof(2.0).positions;
  cloud.positions[7].y() = std::numeric_limits<double>::quiet_NaN();
  const PreparedCloud plain = prepare(cloud);
  EXPECT_FALSE(plain.is_averaged());
  EXPECT_EQ(plain.positions.size(), cloud.size());
  const PreparedCloud prepared = prepare(cloud, {.average_noise = true});
  ASSERT_TRUE(prepared.is_averaged());
  EXPECT_LT(prepared.positions.size(), cloud.size() / 4);
  EXPECT_EQ(prepared.normals.size(), prepared.positions.size());
  ASSERT_EQ(prepared.average_of.size(), cloud.size());
  EXPECT_EQ(prepared.average_of[7], kNoAverage);
  EXPECT_LT(prepared.average_of[6], prepared.positions.size());
  Classification found;
  found.classes.assign(prepared.positions.size(), kSharpEdge);
  found.p_sharp.assign(prepared.positions.size(), 0.75f);
  const Classification all = of_all_points(prepared, found);
  ASSERT_EQ(all.classes.size(), cloud.size());
  EXPECT_EQ(all.classes[7], kUnlabelled);
  EXPECT_EQ(all.p_sharp[7], 0.0f);
  EXPECT_EQ(all.p_sharp[6], 0.75f);
  EXPECT_TRUE(all.p_smooth.empty());
  EXPECT_EQ(all.counts.sharp, cloud.size() - 1);
  EXPECT_EQ(all.counts.unlabelled, 1u);
  const std::vector<Vec3> normals = of_all_points(prepared, prepared.made);
  EXPECT_EQ(normals[6], prepared.made[prepared.average_of[6]]);
  EXPECT_EQ(normals[7], Vec3::Zero());
  found.p_smooth.assign(found.classes.size(), 0.0f);
  add_result(cloud, prepared, found, EdgeModel{});
  EXPECT_EQ(cloud.labels, all.classes);
  EXPECT_EQ(cloud.normals, normals);
}

TEST(Averages, AreNotOfPointsWithNormals) {
  PointCloud cloud;
  cloud.positions = Roof(2.0).positions;
  cloud.normals.assign(cloud.size(), Vec3::UnitZ());
  EXPECT_FALSE(prepare(cloud, {.average_noise = true}).is_averaged());
  set_estimated_normals(cloud, true);
  EXPECT_TRUE(prepare(cloud, {.average_noise = true}).is_averaged());
}

TEST(Averages, TakeTheLabelsOfMostOfTheirPoints) {
  PreparedCloud prepared;
  prepared.moved.resize(3);
  prepared.positions = prepared.moved;
  prepared.average_of = {0, 0, 0, 1, 1, 2, kNoAverage};
  Classification found;
  found.classes = {kSharpEdge, kSharpEdge, kNonEdge, kUnlabelled, 9, kUnlabelled, kSharpEdge};
  found.p_sharp = {0.9f, 0.6f, 0.3f, 0.0f, 0.0f, 0.0f, 1.0f};
  const Classification fewer = of_averages(prepared, found);
  EXPECT_EQ(fewer.classes, (std::vector<std::uint8_t>{kSharpEdge, kNonEdge, kUnlabelled}));
  ASSERT_EQ(fewer.p_sharp.size(), 3u);
  EXPECT_NEAR(fewer.p_sharp[0], 0.6f, 1e-6);
  EXPECT_TRUE(fewer.p_smooth.empty());
}

}  // namespace
}  // namespace pcednet::detect
