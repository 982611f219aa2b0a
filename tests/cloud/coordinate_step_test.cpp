#include "pcednet/cloud/coordinate_step.h"

#include <gtest/gtest.h>

#include <numeric>
#include <vector>

#include "pcednet/core/random.h"

namespace pcednet {
namespace {

double step_of(const std::vector<Vec3>& positions) {
  std::vector<std::uint32_t> points(positions.size());
  std::iota(points.begin(), points.end(), 0u);
  return coordinate_step(positions, points);
}

std::vector<Vec3> multiples_of(const Vec3& steps, const Vec3& origin) {
  Random random(4);
  std::vector<Vec3> positions;
  for (int i = 0; i < 200; ++i) {
    const std::size_t z = random.index(500), y = random.index(500), x = random.index(500);
    const Vec3 multiples(x, y, z);
    positions.push_back(origin + multiples.cwiseProduct(steps));
  }
  return positions;
}

TEST(CoordinateStep, IsTheSmallestOfTheThreeAxes) {
  EXPECT_NEAR(step_of(multiples_of({0.25, 0.1, 0.7}, {0.03, 4e5, -2.0})), 0.1, 1e-9);
}

TEST(CoordinateStep, IsNoneOfAnyCoordinates) {
  Random random(5);
  std::vector<Vec3> positions = multiples_of({0.25, 0.1, 0.7}, Vec3::Zero());
  for (Vec3& p : positions) p.x() = random.uniform();
  EXPECT_LT(step_of(positions), 1e-6);
}

TEST(CoordinateStep, IsZeroForOnePlaceAndForNone) {
  EXPECT_EQ(step_of({}), 0.0);
  EXPECT_EQ(step_of(std::vector<Vec3>(5, Vec3(1.0, 2.0, 3.0))), 0.0);
}

}  // namespace
}  // namespace pcednet
