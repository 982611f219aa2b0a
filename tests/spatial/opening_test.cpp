#include "pcednet/spatial/opening.h"

#include <gtest/gtest.h>

#include <numbers>
#include <vector>

#include "pcednet/spatial/curve_order.h"
#include "pcednet/spatial/kd_tree.h"
#include "pcednet/spatial/neighbour_search.h"

namespace pcednet::spatial {
namespace {

using std::numbers::pi;

TEST(Opening, IsTheWidestAngleBetweenNeighbouringDirections) {
  std::vector<double> angles = {2.0, -1.0, 0.5};
  const Opening opening = widest_opening(angles);
  EXPECT_DOUBLE_EQ(opening.width, 2.0 * pi - 3.0);
  EXPECT_DOUBLE_EQ(opening.middle, 0.5 * (2.0 + 2.0 * pi - 1.0));
}

TEST(Opening, MayLieBetweenTheFirstAndTheLast) {
  std::vector<double> angles = {3.0, -3.0, -1.0};
  const Opening opening = widest_opening(angles);
  EXPECT_DOUBLE_EQ(opening.width, 4.0);
  EXPECT_DOUBLE_EQ(opening.middle, 1.0);
}

TEST(Opening, OfOneDirectionIsAllAround) {
  std::vector<double> angles = {0.25};
  const Opening opening = widest_opening(angles);
  EXPECT_DOUBLE_EQ(opening.width, 2.0 * pi);
  EXPECT_DOUBLE_EQ(opening.middle, 0.25 + pi);
}

/// The nearest 12 others of a point of rows that are `apart`, whose points are 1 apart, are of its
/// own row and the one behind it.
TEST(Opening, BetweenRowsIsNotTheEndOfThem) {
  constexpr double kApart = 5.0;
  std::vector<Vec3> points;
  for (int row = -2; row <= 1; ++row) {
    for (int i = -30; i <= 30; ++i) points.emplace_back(i, kApart * row, 0.0);
  }
  const auto goes_on = [&](const Vec3& at) {
    const auto order = curve_order(points);
    const std::vector<Vec3> ordered = in_order(points, order);
    const KdTree tree(ordered);
    std::vector<Neighbour> others;
    tree.within(at, 6.0, others);
    std::erase_if(others, [&](const Neighbour& other) {
      return other.sq_distance == 0.0 || ordered[other.index].y() > at.y();
    });
    return goes_on_beyond(NeighbourSearch(ordered), at, Vec3::UnitY(), Vec3::UnitZ(), others,
                          [&](std::uint32_t i) -> const Vec3& { return ordered[i]; });
  };
  EXPECT_TRUE(goes_on(Vec3(0.0, 0.0, 0.0)));
  EXPECT_FALSE(goes_on(Vec3(0.0, kApart, 0.0)));
  // A face that meets the last row at a right angle is not what goes on.
  for (int i = -30; i <= 30; ++i) points.emplace_back(i, 1.2 * kApart, 3.0);
  EXPECT_FALSE(goes_on(Vec3(0.0, kApart, 0.0)));
}

}  // namespace
}  // namespace pcednet::spatial
