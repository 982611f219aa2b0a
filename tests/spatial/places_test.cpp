#include "pcednet/spatial/places.h"

#include <gtest/gtest.h>

#include <cmath>

#include "pcednet/core/random.h"
#include "pcednet/spatial/curve_order.h"

namespace pcednet::spatial {
namespace {

std::vector<std::uint32_t> points_at(const Places& places, std::size_t place) {
  const auto points = places.points(place);
  return {points.begin(), points.end()};
}

TEST(Places, HoldPointsOfOnePositionTogether) {
  const std::vector<Vec3> positions = {{1, 0, 0}, {0, 0, 0}, {NAN, 0, 0}, {1, 0, 0},
                                       {2, 0, 0}, {1, 0, 0}, {0, 0, 0}};
  const Places places = places_of(positions, curve_order(positions));
  ASSERT_EQ(places.size(), 3u);
  EXPECT_EQ(places.positions, (std::vector<Vec3>{{0, 0, 0}, {1, 0, 0}, {2, 0, 0}}));
  EXPECT_EQ(points_at(places, 0), (std::vector<std::uint32_t>{1, 6}));
  EXPECT_EQ(points_at(places, 1), (std::vector<std::uint32_t>{0, 3, 5}));
  EXPECT_EQ(points_at(places, 2), (std::vector<std::uint32_t>{4}));
}

TEST(Places, NeedNoStartsWithoutCopies) {
  Random random(3);
  std::vector<Vec3> positions(1000);
  for (Vec3& p : positions) p = {random.uniform(), random.uniform(), random.uniform()};
  const std::vector<std::uint32_t> curve = curve_order(positions);
  const Places places = places_of(positions, curve);
  EXPECT_TRUE(places.starts.empty());
  EXPECT_EQ(places.positions, in_order(positions, curve));
  for (std::size_t i = 0; i < curve.size(); ++i) {
    EXPECT_EQ(points_at(places, i), std::vector<std::uint32_t>{curve[i]});
  }
}

TEST(Places, AreThoseOfAPartOfTheCurve) {
  const std::vector<Vec3> positions = {{0, 0, 0}, {1, 0, 0}, {1, 0, 0}, {2, 0, 0}};
  const Places places = places_of(positions, {2, 3});
  EXPECT_EQ(places.positions, (std::vector<Vec3>{{1, 0, 0}, {2, 0, 0}}));
  EXPECT_EQ(places_of(positions, {}).size(), 0u);
}

}  // namespace
}  // namespace pcednet::spatial
