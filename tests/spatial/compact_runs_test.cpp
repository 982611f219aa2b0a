#include "pcednet/spatial/compact_runs.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <limits>

#include "pcednet/core/random_vectors.h"

namespace pcednet::spatial {
namespace {

TEST(CompactRuns, EndWhereTheCurveJumps) {
  Random random(4);
  std::vector<Vec3> points;
  std::vector<std::uint32_t> jumps;
  for (int clump = 0; clump < 200; ++clump) {
    jumps.push_back(static_cast<std::uint32_t>(points.size()));
    const Vec3 centre(100.0 * (clump % 14), 100.0 * (clump * 5 % 14), 0);
    const std::size_t size = 17 + random.index(30);  // more than a run holds
    for (std::size_t i = 0; i < size; ++i) {
      points.push_back(centre + uniform_vector(random));
    }
  }
  const auto first = cut_compact_runs(points, 16);
  EXPECT_EQ(first.front(), 0u);
  EXPECT_EQ(first.back(), points.size());
  for (std::size_t run = 0; run + 1 < first.size(); ++run) {
    EXPECT_LT(first[run], first[run + 1]);
    EXPECT_LE(first[run + 1] - first[run], 16u);
  }
  for (const std::uint32_t jump : jumps) {
    EXPECT_TRUE(std::binary_search(first.begin(), first.end(), jump)) << jump;
  }
}

TEST(CompactRuns, CutPointsAtOnePlaceToo) {
  EXPECT_EQ(cut_compact_runs({}, 16), std::vector<std::uint32_t>{0});
  const auto first = cut_compact_runs(std::vector<Vec3>(5000, Vec3::Zero()), 16);
  EXPECT_EQ(first.back(), 5000u);
  for (std::size_t run = 0; run + 1 < first.size(); ++run) {
    EXPECT_LE(first[run + 1] - first[run], 16u);
  }
}

TEST(CompactRuns, CutWhereTheTwoSidesWeighLeast) {
  Random random(6);
  for (std::size_t size = 2; size < 40; ++size) {
    std::vector<Vec3> points(size, Vec3::Zero());
    for (std::size_t i = 1; i < size; ++i) {
      points[i] = points[i - 1] + normal_vector(random);
    }
    const auto weight = [&](std::size_t begin, std::size_t end) {
      Vec3 min = points[begin], max = min;
      for (std::size_t i = begin; i < end; ++i) {
        min = min.cwiseMin(points[i]);
        max = max.cwiseMax(points[i]);
      }
      return static_cast<double>(end - begin) * (max - min).sum();
    };
    double least = std::numeric_limits<double>::infinity();
    for (std::size_t i = 1; i < size; ++i) {
      least = std::min(least, weight(0, i) + weight(i, size));
    }
    const auto first = cut_compact_runs(points, size - 1);
    ASSERT_EQ(first.size(), 3u);
    ASSERT_NEAR(weight(0, first[1]) + weight(first[1], size), least, 1e-9) << size;
  }
}

}  // namespace
}  // namespace pcednet::spatial
