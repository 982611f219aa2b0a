#include "pcednet/spatial/kd_tree.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <limits>
#include <vector>

#include "pcednet/core/random.h"

namespace pcednet::spatial {
namespace {

std::vector<Vec3> random_points(std::size_t count, bool on_grid) {
  Random random(5);
  std::vector<Vec3> points(count);
  for (Vec3& p : points) {
    for (int a = 0; a < 3; ++a) {
      p[a] = on_grid ? static_cast<double>(random.index(6)) : random.uniform();
    }
  }
  return points;
}

std::vector<double> brute_force_distances(const std::vector<Vec3>& points, const Vec3& query) {
  std::vector<double> distances;
  for (const Vec3& p : points) {
    if (p.allFinite()) distances.push_back((p - query).squaredNorm());
  }
  std::sort(distances.begin(), distances.end());
  return distances;
}

TEST(KdTree, FindsWhatBruteForceFinds) {
  for (const bool on_grid : {false, true}) {
    auto points = random_points(700, on_grid);
    points[3].x() = std::numeric_limits<double>::quiet_NaN();
    const KdTree tree(points);
    EXPECT_EQ(tree.size(), 699u);
    std::vector<Neighbour> found;
    for (std::size_t q = 10; q < 60; ++q) {
      const auto expected = brute_force_distances(points, points[q]);
      tree.nearest(points[q], 11, found);
      ASSERT_EQ(found.size(), 11u);
      for (std::size_t i = 0; i < found.size(); ++i) {
        EXPECT_DOUBLE_EQ(found[i].sq_distance, expected[i]);
        EXPECT_DOUBLE_EQ((points[found[i].index] - points[q]).squaredNorm(), expected[i]);
      }
      const double radius = on_grid ? 2.0 : 0.2;
      tree.within(points[q], radius, found);
      const auto end = std::lower_bound(expected.begin(), expected.end(), radius * radius);
      ASSERT_EQ(found.size(), static_cast<std::size_t>(end - expected.begin()));
      for (std::size_t i = 0; i < found.size(); ++i) {
        EXPECT_DOUBLE_EQ(found[i].sq_distance, expected[i]);
      }
      std::vector<Neighbour> unsorted;
      tree.within_unsorted(points[q], radius, unsorted);
      const auto by_index = [](const Neighbour& a, const Neighbour& b) {
        return a.index < b.index;
      };
      std::sort(unsorted.begin(), unsorted.end(), by_index);
      std::sort(found.begin(), found.end(), by_index);
      ASSERT_EQ(unsorted.size(), found.size());
      for (std::size_t i = 0; i < found.size(); ++i) {
        EXPECT_EQ(unsorted[i].index, found[i].index);
        EXPECT_EQ(unsorted[i].sq_distance, found[i].sq_distance);
      }
    }
  }
}

TEST(KdTree, AnswersTheSamePositionsForAnyNumbering) {
  const auto points = random_points(500, true);
  auto reversed = points;
  std::reverse(reversed.begin(), reversed.end());
  const KdTree a(points), b(reversed);
  std::vector<Neighbour> from_a, from_b;
  for (const Vec3& query : points) {
    a.nearest(query, 7, from_a);
    b.nearest(query, 7, from_b);
    for (std::size_t i = 0; i < 7; ++i) {
      EXPECT_EQ(points[from_a[i].index], reversed[from_b[i].index]);
    }
    a.within_unsorted(query, 1.5, from_a);
    b.within_unsorted(query, 1.5, from_b);
    ASSERT_EQ(from_a.size(), from_b.size());
    for (std::size_t i = 0; i < from_a.size(); ++i) {
      EXPECT_EQ(points[from_a[i].index], reversed[from_b[i].index]);
    }
  }
}

TEST(KdTree, AnswersOnEmptyAndTinySets) {
  std::vector<Neighbour> found;
  const KdTree empty({});
  empty.nearest(Vec3::Zero(), 5, found);
  EXPECT_TRUE(found.empty());
  empty.within(Vec3::Zero(), 5.0, found);
  EXPECT_TRUE(found.empty());
  empty.within_unsorted(Vec3::Zero(), 5.0, found);
  EXPECT_TRUE(found.empty());
  const std::vector<Vec3> one(3, Vec3(1, 2, 3));
  KdTree(one).nearest(Vec3::Zero(), 5, found);
  EXPECT_EQ(found.size(), 3u);
}

}  // namespace
}  // namespace pcednet::spatial
