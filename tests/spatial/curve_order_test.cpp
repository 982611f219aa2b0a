#include "pcednet/spatial/curve_order.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <limits>
#include <numeric>

#include "pcednet/core/random_vectors.h"
#include "support/expect_error.h"

namespace pcednet::spatial {
namespace {

std::vector<Vec3> random_points(std::size_t count, double size) {
  Random random(7);
  std::vector<Vec3> points;
  for (std::size_t i = 0; i < count; ++i) {
    points.push_back(size * uniform_vector(random));
  }
  return points;
}

/// The mean distance from one point to the next along the order.
double mean_step(const std::vector<Vec3>& points, const std::vector<std::uint32_t>& order) {
  double sum = 0.0;
  for (std::size_t i = 1; i < order.size(); ++i) {
    sum += (points[order[i]] - points[order[i - 1]]).norm();
  }
  return sum / static_cast<double>(order.size() - 1);
}

TEST(CurveOrder, HoldsEveryFinitePointOnce) {
  std::vector<Vec3> points = random_points(5000, 1.0);
  points[3].y() = std::numeric_limits<double>::quiet_NaN();
  points[4].z() = std::numeric_limits<double>::infinity();
  std::vector<std::uint32_t> order = curve_order(points);
  std::sort(order.begin(), order.end());
  std::vector<std::uint32_t> expected(5000);
  std::iota(expected.begin(), expected.end(), 0u);
  expected.erase(expected.begin() + 3, expected.begin() + 5);
  EXPECT_EQ(order, expected);
}

TEST(CurveOrder, DoesNotDependOnTheNumbering) {
  std::vector<Vec3> points = random_points(3000, 1.0);
  for (Vec3& p : points) p = (p * 8).array().floor();  // most places hold several points
  std::vector<Vec3> reversed(points.rbegin(), points.rend());
  const auto order = curve_order(points), again = curve_order(reversed);
  for (std::size_t i = 0; i < order.size(); ++i) EXPECT_EQ(points[order[i]], reversed[again[i]]);
}

TEST(CurveOrder, KeepsTheOrderOfCopies) {
  const std::vector<Vec3> points(1000, Vec3(1, 2, 3));
  const auto order = curve_order(points);
  EXPECT_TRUE(std::is_sorted(order.begin(), order.end()));
}

TEST(CurveOrder, StaysLocalWhenOnePointIsFarFromAll) {
  std::vector<Vec3> points = random_points(20000, 1.0);
  const double alone = mean_step(points, curve_order(points));
  EXPECT_LT(alone, 0.08);  // 0.037 apart if they were on a grid
  points.push_back(Vec3::Constant(1e9));
  auto order = curve_order(points);
  order.pop_back();  // the far one is last: it has the largest key
  EXPECT_LT(mean_step(points, order), 1.2 * alone);
}

TEST(CurveOrder, SurvivesTheLargestCoordinates) {
  std::vector<Vec3> points = random_points(200, 1e308);
  points.push_back(Vec3::Constant(-1.7e308));
  points.push_back(Vec3::Constant(1.7e308));
  EXPECT_EQ(curve_order(points).size(), points.size());
}

TEST(CurveOrder, RefusesMorePointsThanIndicesCount) {
  const Vec3 point = Vec3::Zero();  // the others are not read
  for (const std::size_t count : {std::size_t{0xffffffff}, std::size_t{1} << 32}) {
    EXPECT_ERROR(ErrorKind::kFailure, curve_order({&point, count}));
  }
}

}  // namespace
}  // namespace pcednet::spatial
