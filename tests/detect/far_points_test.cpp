#include "pcednet/detect/points/far_points.h"

#include <gtest/gtest.h>

#include <limits>
#include <vector>

namespace pcednet::detect {
namespace {

constexpr double kNoData = 1e30;

std::vector<Vec3> row(std::size_t points) {
  std::vector<Vec3> positions;
  for (std::size_t i = 0; i < points; ++i) positions.emplace_back(i, 0.0, 0.0);
  return positions;
}

TEST(FarPoints, AreThoseOfNoData) {
  std::vector<Vec3> positions = row(10);
  positions[4] = Vec3(kNoData, 0, 0);
  positions[7] = Vec3::Constant(-std::numeric_limits<float>::max());
  positions[8] = Vec3::Constant(std::numeric_limits<double>::quiet_NaN());
  EXPECT_EQ(far_points(positions), (std::vector<std::uint32_t>{4, 7}));
}

TEST(FarPoints, AreTheSameIfMostPointsHaveNoData) {
  std::vector<Vec3> positions = row(10);
  for (std::size_t i = 4; i < positions.size(); ++i) positions[i] = Vec3::Constant(kNoData);
  EXPECT_EQ(far_points(positions), (std::vector<std::uint32_t>{4, 5, 6, 7, 8, 9}));
}

TEST(FarPoints, AreNotTheRestIfMostPointsAreInOnePlace) {
  std::vector<Vec3> positions = row(10);
  for (std::size_t i = 0; i < 6; ++i) positions[i] = Vec3::Zero();
  positions[9] = Vec3(0, kNoData, 0);
  EXPECT_EQ(far_points(positions), (std::vector<std::uint32_t>{9}));
}

TEST(FarPoints, AreNoneInALargeOrAnEmptyCloud) {
  std::vector<Vec3> positions = row(10);
  for (Vec3& position : positions) position *= kNoData;
  EXPECT_TRUE(far_points(positions).empty());
  EXPECT_TRUE(far_points({}).empty());
}

}  // namespace
}  // namespace pcednet::detect
