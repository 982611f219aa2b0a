#include "pcednet/spatial/box_tree.h"

#include <gtest/gtest.h>

#include <cmath>

#include "pcednet/core/random_vectors.h"
#include "pcednet/spatial/curve_order.h"

namespace pcednet::spatial {
namespace {

/// Points in curve order: a cloud, a dense clump in it, and copies of one place.
std::vector<Vec3> ordered_points() {
  Random random(3);
  std::vector<Vec3> points;
  const auto place = [&] { return uniform_vector(random); };
  for (int i = 0; i < 3000; ++i) points.push_back(place());
  for (int i = 0; i < 1000; ++i) points.push_back(Vec3(0.3, 0.2, 0.1) + 1e-4 * place());
  for (int i = 0; i < 50; ++i) points.push_back(Vec3(0.7, 0.7, 0.7));
  std::vector<Vec3> ordered;
  for (const std::uint32_t i : curve_order(points)) ordered.push_back(points[i]);
  return ordered;
}

double sq_gap(const Vec3& p, const Vec3& min, const Vec3& max) {
  return (min - p).cwiseMax(p - max).cwiseMax(0.0).squaredNorm();
}

TEST(BoxTree, FindsAllNearABox) {
  for (const double far : {0.0, 0x1p23}) {  // boxes in float must not lose a point
    const Vec3 corner = Vec3::Constant(far);
    std::vector<Vec3> points = ordered_points();
    for (Vec3& p : points) p += corner;
    const BoxTree tree(points.size(), [&](std::size_t i) { return points[i]; });
    Random random(4);
    for (int query = 0; query < 200; ++query) {
      const Vec3 min = corner + uniform_vector(random);
      const Vec3 max = min + Vec3::Constant(query % 2 ? 0.05 : 0.0);
      const double distance = query % 3 ? 0.1 : 1e-5;
      std::vector<std::uint32_t> runs;
      tree.runs_near(min, max, distance, runs);
      EXPECT_TRUE(std::is_sorted(runs.begin(), runs.end()));
      std::size_t within = 0, found = 0;
      for (std::size_t i = 0; i < points.size(); ++i) {
        if (sq_gap(points[i], min, max) >= distance * distance) continue;
        ++within;
        const auto run = static_cast<std::uint32_t>(i / BoxTree::kLeaf);
        found += std::binary_search(runs.begin(), runs.end(), run);
      }
      EXPECT_EQ(found, within);
    }
  }
}

TEST(BoxTree, FindsEveryPointAtItsPlace) {
  const std::vector<Vec3> points = ordered_points();
  const BoxTree tree(points.size(), [&](std::size_t i) { return points[i]; });
  for (std::size_t i = 0; i < points.size(); ++i) {
    std::vector<std::uint32_t> runs;
    tree.runs_near(points[i], points[i], 1e-100, runs);
    const auto run = static_cast<std::uint32_t>(i / BoxTree::kLeaf);
    ASSERT_TRUE(std::binary_search(runs.begin(), runs.end(), run)) << i;
  }
}

TEST(BoxTree, FindsNoMoreFarFromTheFirstPoints) {
  // Where two clumps are far apart, each is as finely divided as it would be alone, but for the
  // family of boxes that reaches from one to the other.
  std::vector<Vec3> points = ordered_points();
  const std::size_t here = points.size();
  for (std::size_t i = 0; i < here; ++i) points.push_back(points[i] + Vec3::Constant(0x1p30));
  for (Vec3& p : points) p -= Vec3::Constant(0x1p30), p += Vec3::Constant(0x1p30);
  const BoxTree tree(points.size(), [&](std::size_t i) { return points[i]; });
  std::vector<std::uint32_t> near, far;
  const Vec3 there = points[here];
  tree.runs_near(points.front(), points.front(), 0.05, near);
  tree.runs_near(there, there, 0.05, far);
  EXPECT_GT(near.size(), 0u);
  EXPECT_LE(far.size(), near.size() + BoxTree::kFanOut);
}

TEST(BoxTree, FindsTheNearestAsASortOfAllDistances) {
  const std::vector<Vec3> points = ordered_points();
  const auto position_at = [&](std::size_t i) { return points[i]; };
  const BoxTree tree(points.size(), position_at);
  Random random(5);
  for (int query = 0; query < 100; ++query) {
    const std::size_t item = random.index(points.size());
    std::vector<double> expected;
    for (const Vec3& p : points) {
      const Vec3 d = p - points[item];
      expected.push_back(d.x() * d.x() + d.y() * d.y() + d.z() * d.z());
    }
    std::sort(expected.begin(), expected.end());
    std::array<double, 11> found;
    ASSERT_EQ(tree.nearest(item, found, position_at), 11u);
    for (std::size_t i = 0; i < 11; ++i) EXPECT_EQ(found[i], expected[i]);
  }
}

TEST(BoxTree, IsContentWithFewOrNoThings) {
  std::vector<Vec3> points;
  const auto position_at = [&](std::size_t i) { return points[i]; };
  std::array<double, 11> found;
  std::vector<std::uint32_t> runs;
  const BoxTree none(0, position_at);
  none.runs_near(Vec3::Zero(), Vec3::Ones(), 1.0, runs);
  EXPECT_TRUE(runs.empty());
  points = {Vec3::Zero(), Vec3::UnitX()};
  const BoxTree two(2, position_at);
  EXPECT_EQ(two.nearest(0, found, position_at), 2u);
  EXPECT_EQ(found[1], 1.0);
}

}  // namespace
}  // namespace pcednet::spatial
