#include "workbench/shapes/relief.h"

#include <gtest/gtest.h>

#include <algorithm>

#include "workbench/shapes/surfaces/sampling.h"

namespace pcednet::shapes {
namespace {

TEST(Relief, HasItsLinesOnTheSurface) {
  for (std::uint64_t seed = 0; seed < 12; ++seed) {
    Random random(seed, 1);
    const Relief relief = random_relief(random, 5000);
    ASSERT_EQ(relief.shape.patches.size(), 1u);
    ASSERT_FALSE(relief.lines.empty()) << seed;
    const auto& patch = relief.shape.patches[0];
    const Vec3 low = patch.at(0, 0).position, high = patch.at(1, 1).position;
    for (const Vec3& p : relief.lines) {
      const double u = (p.x() - low.x()) / (high.x() - low.x());
      const double v = (p.y() - low.y()) / (high.y() - low.y());
      EXPECT_NEAR(patch.at(u, v).position.z(), p.z(), 1e-9);
      EXPECT_TRUE(u >= 0 && u <= 1 && v >= 0 && v <= 1);
    }
  }
}

TEST(Relief, TurnsMoreAtItsLinesThanElsewhere) {
  // How far the normal turns over a small step, on the lines and at random places.
  for (std::uint64_t seed = 0; seed < 12; ++seed) {
    Random random(seed, 1);
    const Relief relief = random_relief(random, 5000);
    const auto& patch = relief.shape.patches[0];
    const Vec3 low = patch.at(0, 0).position, high = patch.at(1, 1).position;
    const auto turn = [&](double u, double v) {
      double most = 0.0;
      for (const auto& [du, dv] : {std::pair{0.004, 0.0}, {0.0, 0.004}}) {
        const Vec3 a = patch.at(std::max(0.0, u - du), std::max(0.0, v - dv)).normal;
        const Vec3 b = patch.at(std::min(1.0, u + du), std::min(1.0, v + dv)).normal;
        most = std::max(most, (a - b).norm());
      }
      return most;
    };
    double on_lines = 0.0, anywhere = 0.0;
    for (const Vec3& p : relief.lines) {
      on_lines +=
          turn((p.x() - low.x()) / (high.x() - low.x()), (p.y() - low.y()) / (high.y() - low.y())) /
          static_cast<double>(relief.lines.size());
    }
    for (int i = 0; i < 2000; ++i) {
      const double u = random.uniform(), v = random.uniform();
      anywhere += turn(u, v) / 2000;
    }
    EXPECT_GT(on_lines, 1.5 * anywhere) << seed;
  }
}

TEST(ReliefSet, MakesLabelledCloudsAndTheSameAgain) {
  auto recipes = relief_recipes(3);
  for (std::size_t i = 0; i < 4; ++i) {
    recipes[i].points = 2000;
    const PointCloud cloud = generate(recipes[i], 3).cloud;
    ASSERT_EQ(cloud.size(), 2000u);
    const auto sharp = std::count(cloud.labels.begin(), cloud.labels.end(), kSharpEdge);
    EXPECT_GT(sharp, 10) << recipes[i].name;
    EXPECT_LT(sharp, 1800) << recipes[i].name;
    const auto rim = std::count(cloud.labels.begin(), cloud.labels.end(), kBoundary);
    EXPECT_GT(rim, 40) << recipes[i].name;
    EXPECT_LT(rim, 250) << recipes[i].name;
    for (const Vec3& normal : cloud.normals) EXPECT_NEAR(normal.norm(), 1.0, 1e-9);
    EXPECT_EQ(generate(recipes[i], 3).cloud.positions, cloud.positions);
  }
  EXPECT_NE(generate(recipes[0], 4).cloud.positions, generate(recipes[0], 3).cloud.positions);
}

}  // namespace
}  // namespace pcednet::shapes
