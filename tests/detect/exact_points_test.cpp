#include "pcednet/detect/points/exact_points.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <numeric>

#include "labelled_cube.h"
#include "pcednet/core/random.h"
#include "pcednet/detect/points/prepare.h"

namespace pcednet::detect {
namespace {

TEST(ExactPoints, LieOnPlaneFacesWithoutNoise) {
  PointCloud cloud = cube(3000, 1);
  cloud.normals.clear();
  EXPECT_TRUE(prepare(cloud).decision.exact);
  for (std::size_t i = 0; i < cloud.positions.size(); ++i) {  // a hundredth of the spacing
    cloud.positions[i] *= 1.0 + 5e-4 * static_cast<double>(i % 7);
  }
  EXPECT_FALSE(prepare(cloud).decision.exact);
}

TEST(ExactPoints, AreNotThoseOfScanLinesOverRoughGround) {
  PointCloud cloud;
  Random random(1);
  for (int line = 0; line < 40; ++line) {  // each in a vertical plane through the scanner
    const double angle = 0.01 * line;
    for (int i = 0; i < 100; ++i) {
      const double range = 5.0 + 0.005 * i;
      const double height = 0.1 * std::sin(9.0 * range) + 0.002 * random.normal();
      cloud.positions.emplace_back(range * std::cos(angle), range * std::sin(angle), height);
    }
  }
  EXPECT_FALSE(prepare(cloud).decision.exact);
}

TEST(ExactPoints, MayLieOnCurvedFacesMostly) {
  PointCloud cloud;
  Random random(1);
  for (int i = 0; i < 5000; ++i) {  // a drum, three quarters of its surface round
    const double angle = random.uniform(0.0, 6.2831853);
    if (i % 4 == 0) {
      const double radius = std::sqrt(random.uniform());
      cloud.positions.emplace_back(radius * std::cos(angle), radius * std::sin(angle),
                                   i % 8 == 0 ? 0.0 : 3.0);
    } else {
      cloud.positions.emplace_back(std::cos(angle), std::sin(angle), random.uniform(0.0, 3.0));
    }
  }
  EXPECT_TRUE(prepare(cloud).decision.exact);
}

TEST(ExactPoints, AreNotThoseOfAGrid) {
  PointCloud cloud;
  for (int x = 0; x < 60; ++x) {  // a bend between two planes, as a blurred volume has
    for (int y = 0; y < 60; ++y) cloud.positions.emplace_back(x, y, std::max(0, x - 30));
  }
  EXPECT_FALSE(prepare(cloud).decision.exact);
}

TEST(ExactPoints, AreNoFewPointsOrCopiesOfThem) {
  const std::vector<Vec3> positions(100, Vec3(1.0, 2.0, 3.0));
  std::vector<std::uint32_t> curve(100);
  std::iota(curve.begin(), curve.end(), 0u);
  EXPECT_FALSE(is_exact(positions, curve));
  EXPECT_FALSE(is_exact({}, {}));
}

}  // namespace
}  // namespace pcednet::detect
