#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <numeric>

#include "made_clouds.h"
#include "pcednet/core/random.h"
#include "pcednet/lines/find_lines.h"
#include "pcednet/lines/points/ordered_points.h"
#include "pcednet/lines/points/sampling.h"
#include "support/scanned_ground.h"

namespace pcednet::lines {
namespace {

constexpr double kEdgeLength = 40.0, kFaceWidth = 12.0;

struct Faces {
  std::vector<Vec3> positions = {}, normals = {};
  std::vector<std::uint8_t> classes = {};

  EdgePoints points() const { return {positions, normals, classes}; }

  /// A face along y, and away from it; its points labelled within 0.7 spacings of the edge.
  void add_face(const Vec3& away, const Vec3& normal, double spacing, Random& random) {
    const auto count = static_cast<int>(kEdgeLength * kFaceWidth / (spacing * spacing));
    for (int i = 0; i < count; ++i) {
      const double from_edge = kFaceWidth * random.uniform();
      positions.push_back(from_edge * away + kEdgeLength * random.uniform() * Vec3::UnitY());
      normals.push_back(normal);
      classes.push_back(from_edge < 0.7 * spacing ? kSharpEdge : kNonEdge);
    }
  }

  void add_ground(double spacing, Random& random) {
    for (int i = 0; i < 30000; ++i) {
      const double y = 170.0 * spacing * random.uniform(), x = 170.0 * spacing * random.uniform();
      positions.emplace_back(1000.0 + x, y, 0.0);
      normals.push_back(Vec3::UnitZ());
      classes.push_back(kNonEdge);
    }
  }
};

/// The floor and wall of a scan that looks at the floor and along the wall.
Faces floor_and_wall(double of_floor, double of_wall) {
  Random random(11);
  Faces cloud;
  cloud.add_face(Vec3::UnitX(), Vec3::UnitZ(), of_floor, random);
  cloud.add_face(Vec3::UnitZ(), Vec3::UnitX(), of_wall, random);
  return cloud;
}

double length_along_edge(const std::vector<Curve>& curves) {
  double length = 0.0;
  for (const Curve& curve : curves) {
    const bool is_on_edge =
        std::all_of(curve.points.begin(), curve.points.end(),
                    [](const Vec3& p) { return std::hypot(p.x(), p.z()) < 0.5; });
    if (is_on_edge) length += length_of(curve);
  }
  return length;
}

TEST(UnevenLines, FollowTheEdgeBetweenADenseFaceAndASparseOne) {
  for (const double of_wall : {0.3, 0.9}) {
    const std::vector<Curve> curves = find_lines(floor_and_wall(0.3, of_wall).points());
    EXPECT_GT(length_along_edge(curves), 0.9 * kEdgeLength) << of_wall;
    EXPECT_LT(length_along_edge(curves), 1.01 * kEdgeLength) << of_wall;
    EXPECT_LE(curves.size(), 3u) << of_wall;
  }
}

TEST(UnevenLines, TakeTheSpacingOfTheCloudWhereHardlyAPointIsOffEdges) {
  // What is left of a cube near its edges, and a stray point or some of its faces.
  for (const std::size_t others : {1, 20}) {
    const Cloud whole = cube(60000);
    Cloud cloud{.spacing = whole.spacing};
    std::size_t kept = 0;
    for (std::size_t i = 0; i < whole.positions.size(); ++i) {
      const bool edge = whole.classes[i] == kSharpEdge;
      const bool stray = !edge && others == 1;
      if (edge || kept < others) {
        cloud.add(stray ? Vec3(4, 4, 4) : whole.positions[i], whole.normals[i], edge);
      }
      kept += edge ? 0 : 1;
    }
    const Sampling sampling = measure_sampling(OrderedPoints(points_of(cloud)));
    EXPECT_LT(sampling.spacing, 3.0 * whole.spacing) << others;
  }
}

TEST(UnevenLines, DrawEachEdgeOfAMuchFinerPartOnce) {
  for (const double finer : {4.0, 8.0, 16.0}) {  // exact surfaces took hours
    Cloud cloud = cube(20000);
    Random random(14);
    const double ground = 200.0 * finer * cloud.spacing;
    for (int i = 0; i < 40000; ++i) {
      const double x = random.uniform(), y = random.uniform();
      cloud.add(Vec3(ground * (x - 0.5), ground * (y - 0.5), -0.2), Vec3::UnitZ(), false);
    }
    const std::vector<Curve> curves = lines_of(cloud);
    EXPECT_EQ(curves.size(), 12u) << finer;
    for (const Curve& curve : curves) EXPECT_NEAR(length_of(curve), 1.0, 0.02) << finer;
  }
}

TEST(UnevenLines, AreTheSameForAnyOrderOfThePoints) {
  const Faces cloud = floor_and_wall(0.3, 0.9);
  std::vector<std::size_t> order(cloud.positions.size());
  std::iota(order.begin(), order.end(), std::size_t{0});
  Random(12).shuffle(std::span(order));
  Faces shuffled;
  for (const std::size_t i : order) {
    shuffled.positions.push_back(cloud.positions[i]);
    shuffled.normals.push_back(cloud.normals[i]);
    shuffled.classes.push_back(cloud.classes[i]);
  }
  const std::vector<Curve> a = find_lines(cloud.points()), b = find_lines(shuffled.points());
  ASSERT_EQ(a.size(), b.size());
  ASSERT_FALSE(a.empty());
  for (std::size_t i = 0; i < a.size(); ++i) EXPECT_EQ(a[i].points, b[i].points);
}

TEST(UnevenLines, TakeTheSpacingOfEdgesWhereItIsMuchWider) {
  Faces cloud = floor_and_wall(1.0, 1.0);
  Random random(13);
  cloud.add_ground(0.1, random);
  const Sampling sampling = measure_sampling(OrderedPoints(cloud.points()));
  EXPECT_NEAR(sampling.spacing, 1.0, 0.1);
  EXPECT_LT(sampling.noise, 1e-6);
}

TEST(UnevenLines, MeasureNoiseInTheSpacingOfEdges) {
  Faces cloud = floor_and_wall(1.0, 1.0);
  Random random(13);
  cloud.add_ground(0.1, random);
  for (std::size_t i = 0; i < cloud.positions.size(); ++i) {
    cloud.positions[i] += 0.05 * random.normal() * cloud.normals[i];
  }
  // Half a spacing of the ground, a twentieth of one at the edge.
  EXPECT_LT(measure_sampling(OrderedPoints(cloud.points())).noise, 0.1);
}

/// A wall in the plane y = 0 in upright scan lines .2 apart, one point each .01 along them. Normals
/// estimated from the nearest points are `inside` but at the ends of the lines.
std::vector<Curve> boundaries_of_scanned_wall(const Vec3& inside) {
  Random random(3);
  std::vector<Vec3> positions, normals;
  for (int line = 0; line <= 20; ++line) {
    for (double z = 0.01 * random.uniform(); z < 4.0; z += 0.01) {
      positions.emplace_back(0.2 * line, 0.002 * random.normal(), z);
      normals.push_back(std::abs(z - 2.0) < 1.8 ? inside : Vec3::UnitY());
    }
  }
  const std::vector<std::uint8_t> classes(positions.size(), kNonEdge);
  return find_lines({positions, normals, classes}, {.boundaries = true});
}

TEST(Uneven, ScanLinesFarApartAreNoEndsOfTheSurface) {
  for (const Vec3& inside : {Vec3(Vec3::UnitY()), Vec3(Vec3::UnitX())}) {
    double length = 0.0;
    for (const Curve& curve : boundaries_of_scanned_wall(inside)) {
      length += length_of(curve);
      for (const Vec3& p : curve.points) {
        const double to_end = std::min(
            {std::abs(p.x()), std::abs(p.x() - 4.0), std::abs(p.z()), std::abs(p.z() - 4.0)});
        EXPECT_LT(to_end, 0.15) << p.transpose();
      }
    }
    EXPECT_NEAR(length, 16.0, 1.0);
  }
}

TEST(UnevenLines, EndTheGroundAroundAScannerAtItsOutlineAlone) {
  Faces ground;
  ground.positions = scanned_ground();
  ground.normals.assign(ground.positions.size(), Vec3::UnitZ());
  ground.classes.assign(ground.positions.size(), kNonEdge);
  double length = 0.0;
  for (const Curve& curve : find_lines(ground.points(), {.boundaries = true})) {
    length += length_of(curve);
  }
  const double outline =
      2.0 * (kFarthestGround - kNearestGround) + 2.0 * (kFarthestGround + kNearestGround);
  EXPECT_NEAR(length, outline, 0.1 * outline);
}

}  // namespace
}  // namespace pcednet::lines
