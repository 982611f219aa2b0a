// What is measured of points, and the creases beside them.
#include "pcednet/lines/points/sampling.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

#include "lines/made_clouds.h"
#include "pcednet/core/random.h"
#include "pcednet/lines/creases/crease.h"
#include "pcednet/lines/points/ordered_points.h"

namespace pcednet::lines {
namespace {

TEST(Sampling, IsMeasuredAtAllPointsIfAllAreOfAnEdge) {
  Cloud cloud = cube(3000);
  const auto measured = [&] {
    return measure_sampling(OrderedPoints({cloud.positions, cloud.normals, cloud.classes}));
  };
  EXPECT_NEAR(measured().spacing, cloud.spacing, 0.1 * cloud.spacing);
  std::fill(cloud.classes.begin(), cloud.classes.end(), kSharpEdge);
  EXPECT_NEAR(measured().spacing, cloud.spacing, 0.1 * cloud.spacing);
}

TEST(Sampling, TakesDrawnPointsForExactButNotRoundedOnes) {
  const auto is_exact = [](double noise, double step) {
    Random random(3);
    Cloud cloud = cube(6000);
    for (Vec3& p : cloud.positions) {
      for (double& x : p) {
        x += noise * cloud.spacing * random.normal();
        if (step > 0.0) x = std::round(x / (step * cloud.spacing)) * step * cloud.spacing;
      }
    }
    return measure_sampling(OrderedPoints({cloud.positions, cloud.normals, cloud.classes})).exact;
  };
  EXPECT_TRUE(is_exact(0.0, 0.0));
  EXPECT_TRUE(is_exact(0.0, 0.001));
  EXPECT_FALSE(is_exact(0.0, 0.7));
  EXPECT_FALSE(is_exact(0.05, 0.0));
}

TEST(Sampling, TakesThinWallsForNoNoise) {
  const auto noise_of_walls = [](double noise) {
    Random random(9);
    Cloud cloud;
    const auto add = [&](double x, double z) {
      cloud.add({x, 30.0 * random.uniform(), z + noise * random.normal()}, Vec3::UnitZ(), false);
    };
    for (int i = 0; i < 900; ++i) add(30.0 * random.uniform(), 0.0);
    for (int i = 0; i < 3600; ++i) add(60.0 + 60.0 * random.uniform(), i % 2 == 0 ? 0.0 : 0.7);
    return measure_sampling(OrderedPoints({cloud.positions, cloud.normals, cloud.classes})).noise;
  };
  EXPECT_LT(noise_of_walls(0.0), 1e-6);
  EXPECT_GT(noise_of_walls(0.3), 0.15);
}

TEST(Sampling, ThinWallsEverywhereAreNoNoise) {
  const auto noise_of_wall = [](double noise, double sign) {
    Random random(9);
    Cloud cloud;
    for (int i = 0; i < 6000; ++i) {
      const double z = (i % 2 == 0 ? 0.0 : 1.2) + noise * random.normal();
      const Vec3 normal = random.uniform() < 0.5 ? Vec3(0, 0, sign) : Vec3(0, 0, -sign);
      cloud.add({55.0 * random.uniform(), 55.0 * random.uniform(), z}, normal, false);
    }
    return measure_sampling(OrderedPoints({cloud.positions, cloud.normals, cloud.classes})).noise;
  };
  EXPECT_LT(noise_of_wall(0.0, 1.0), 1e-6);
  EXPECT_GT(noise_of_wall(0.5, 1.0), 0.25);
  EXPECT_EQ(noise_of_wall(0.2, 1.0), noise_of_wall(0.2, -1.0));
}

TEST(Sampling, TheSidesOfAWallAreNoLayersOfScans) {
  for (const double thickness : {1.2, 2.0, 2.6, 3.2}) {
    Random random(5);
    Cloud cloud;
    for (int i = 0; i < 6000; ++i) {
      const bool above = i % 2 == 0;
      const double x = 55.0 * random.uniform(), y = 55.0 * random.uniform();
      cloud.add({x, y, above ? thickness : 0.0}, above ? Vec3(0, 0, 1) : Vec3(0, 0, -1), false);
    }
    const OrderedPoints points({cloud.positions, cloud.normals, cloud.classes});
    EXPECT_LT(measure_sampling(points).noise, 1e-6) << thickness;
  }
}

TEST(Sampling, TakesScansThatAreNotAlignedForNoise) {
  const auto noise_of_scans = [](double apart) {  // in spacings
    Random random(4);
    Cloud cloud = cube(30'000);
    std::vector<Vec3> shifts;
    for (int k = 0; k < 4; ++k) shifts.push_back(apart * cloud.spacing * normal_vector(random));
    for (Vec3& p : cloud.positions) {
      p += shifts[random.index(4)] + 0.02 * cloud.spacing * normal_vector(random);
    }
    return measure_sampling(OrderedPoints({cloud.positions, cloud.normals, cloud.classes})).noise;
  };
  EXPECT_LT(noise_of_scans(0.0), 0.05);
  EXPECT_GT(noise_of_scans(1.2), 0.25);
}

/// Two walls and a chamfer between them, along y; points about one apart, the chamfer labelled.
Cloud chamfer(double from_corner) {
  Random random(6);
  Cloud cloud{.spacing = 1.0};
  const double width = std::sqrt(2.0) * from_corner, length = 60.0, wall = 10.0;
  const auto at = [&] { return length * random.uniform(); };
  for (int i = 0; i < static_cast<int>(length * wall); ++i) {
    cloud.add({from_corner + wall * random.uniform(), at(), 0.0}, Vec3::UnitZ(), false);
    cloud.add({0.0, at(), from_corner + wall * random.uniform()}, Vec3::UnitX(), false);
  }
  for (int i = 0; i < static_cast<int>(length * width); ++i) {
    const double x = from_corner * random.uniform();
    cloud.add({x, at(), from_corner - x}, Vec3(1, 0, 1).normalized(), true);
  }
  return cloud;
}

TEST(Creases, OfAChamferAreNotWhereItsNeighboursWouldMeet) {
  constexpr double kFromCorner = 2.6;
  const Cloud cloud = chamfer(kFromCorner);
  const OrderedPoints points({cloud.positions, cloud.normals, cloud.classes});
  std::size_t on_edges = 0, in_the_air = 0;
  for (const Crease& crease : find_creases(points, {.spacing = 1.0, .noise = 0.0}, nullptr)) {
    const double x = crease.at.x(), z = crease.at.z();
    on_edges += std::hypot(std::max(x, z) - kFromCorner, std::min(x, z)) < 0.5;
    in_the_air += std::hypot(x, z) < 0.5;
  }
  EXPECT_GT(on_edges, 50u);
  EXPECT_EQ(in_the_air, 0u);
}

}  // namespace
}  // namespace pcednet::lines
