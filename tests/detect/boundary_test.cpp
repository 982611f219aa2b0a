#include "pcednet/detect/boundary.h"
#include "pcednet/core/random_vectors.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <iterator>
#include <limits>
#include <numeric>

#include "detect/labelled_cube.h"
#include "detect/left_part.h"
#include "pcednet/core/parallel.h"
#include "pcednet/detect/decide.h"
#include "pcednet/detect/result_cloud.h"
#include "pcednet/detect/train.h"
#include "support/expect_error.h"
#include "support/scanned_ground.h"

namespace pcednet::detect {
namespace {

constexpr double kHole = 0.2;  // its radius, in the middle of the sheet

/// `points` random points of the unit square with a hole; noise is relative to the spacing.
PointCloud sheet(std::size_t points, double noise = 0.0) {
  Random random(7);
  PointCloud cloud;
  const double sigma = noise / std::sqrt(static_cast<double>(points));
  while (cloud.size() < points) {
    const double y = random.uniform(), x = random.uniform();
    const Vec3 p(x, y, 0.0);
    if ((p - Vec3(0.5, 0.5, 0.0)).norm() < kHole) continue;
    cloud.positions.push_back(p + sigma * normal_vector(random));
    cloud.normals.push_back(Vec3::UnitZ());
  }
  return cloud;
}

double distance_to_rim(const Vec3& p) {
  const double outer = std::min({p.x(), 1.0 - p.x(), p.y(), 1.0 - p.y()});
  return std::min(std::abs(outer), std::abs((p - Vec3(0.5, 0.5, 0.0)).norm() - kHole));
}

std::vector<std::uint32_t> boundary_of(const PointCloud& cloud) {
  std::vector<std::uint32_t> points;
  for (const BoundaryPoint& found : find_boundary(prepare(cloud))) points.push_back(found.point);
  return points;
}

double share_found(const PointCloud& cloud) {
  return static_cast<double>(boundary_of(cloud).size()) / static_cast<double>(cloud.size());
}

/// Expects most of what is found within 1.5 spacings of the rim, and at least this share of the rim
/// within one of what is found.
void expect_rim(const PointCloud& cloud, double least_met = 0.85) {
  const double spacing = std::sqrt((1.0 - 3.1416 * kHole * kHole) / double(cloud.size()));
  const std::vector<std::uint32_t> found = boundary_of(cloud);
  ASSERT_FALSE(found.empty());
  const auto near = std::count_if(found.begin(), found.end(), [&](std::uint32_t i) {
    return distance_to_rim(cloud.positions[i]) < 1.5 * spacing;
  });
  EXPECT_GT(double(near), 0.9 * double(found.size()));
  std::size_t rim = 0, met = 0;
  for (const Vec3& p : cloud.positions) {
    if (distance_to_rim(p) > 0.7 * spacing) continue;
    ++rim;
    met += std::any_of(found.begin(), found.end(),
                       [&](std::uint32_t i) { return (cloud.positions[i] - p).norm() < spacing; });
  }
  EXPECT_GT(double(met), least_met * double(rim));
}

TEST(Boundary, IsTheRimOfASheetAndOfItsHole) {
  expect_rim(sheet(5000));
  expect_rim(sheet(5000, 0.2));
  expect_rim(sheet(5000, 0.6), 0.6);  // the rim itself is noise
}

TEST(Boundary, IsFoundWithoutNormals) {
  PointCloud cloud = sheet(3000);
  cloud.normals.clear();
  expect_rim(cloud);
}

TEST(Boundary, OfALargeCloudIsFoundBesideAPointFarFromIt) {
  PointCloud cloud = sheet(200000);
  const auto found = boundary_of(cloud);
  const double spacing = 1.0 / std::sqrt(200000.0);
  const auto hole = std::count_if(found.begin(), found.end(), [&](std::uint32_t i) {
    return std::abs((cloud.positions[i] - Vec3(0.5, 0.5, 0.0)).norm() - kHole) < 1.5 * spacing;
  });
  // Five points in six spacings: of the outermost points few are missing.
  EXPECT_GT(double(hole), 5.0 / 6.0 * 2.0 * 3.1416 * kHole / spacing);
  EXPECT_GT(double(found.size() - static_cast<std::size_t>(hole)), 5.0 / 6.0 * 4.0 / spacing);

  cloud.positions.emplace_back(0.0, 0.0, -100.0);
  cloud.normals.push_back(Vec3::UnitZ());
  const auto beside = boundary_of(cloud);
  std::vector<std::uint32_t> both;
  std::set_intersection(found.begin(), found.end(), beside.begin(), beside.end(),
                        std::back_inserter(both));
  EXPECT_GT(both.size(), 0.99 * double(found.size()));
}

TEST(Boundary, OfAPartIsThatOfTheLargeCloud) {
  PointCloud cloud = sheet(200000);
  std::erase_if(cloud.positions, [](const Vec3& p) {  // holes of a few spacings: some are missed
    const Vec3 from_middle(std::fmod(p.x(), 0.04) - 0.02, std::fmod(p.y(), 0.04) - 0.02, 0.0);
    return from_middle.norm() < 0.005;
  });
  cloud.normals.resize(cloud.size(), Vec3::UnitZ());
  const PreparedCloud whole = prepare(cloud);
  const LeftPart half(cloud, 0.55);
  PreparedCloud prepared = prepare(half.cloud);
  prepared.part = &half.part;
  std::vector<std::uint32_t> of_whole, of_part;
  for (const BoundaryPoint& found : find_boundary(whole)) {
    if (cloud.positions[found.point].x() < 0.5) of_whole.push_back(found.point);
  }
  for (const BoundaryPoint& found : find_boundary(prepared)) {
    if (half.cloud.positions[found.point].x() < 0.5) of_part.push_back(half.numbers[found.point]);
  }
  EXPECT_GT(of_whole.size(), 500u);
  EXPECT_EQ(of_part, of_whole);
}

TEST(Boundary, OfAClosedSolidIsNone) {
  EXPECT_LT(share_found(cube(8000, 3)), 0.001);
  PointCloud noisy = cube(8000, 3);
  Random random(5);
  for (Vec3& p : noisy.positions) {
    p += 0.5 * std::sqrt(6.0 / 8000.0) * normal_vector(random);
  }
  noisy.normals.clear();
  EXPECT_LT(share_found(noisy), 0.005);
}

TEST(Boundary, OfScanLinesIsNoneBetweenThem) {
  Random random(9);
  PointCloud cloud;  // rows five times as far from each other as their points, around a cylinder
  for (int row = 0; row < 60; ++row) {
    for (int i = 0; i < 300; ++i) {
      const double angle = 2.0 * 3.14159265 * (i + random.uniform()) / 300.0;
      const Vec3 normal(std::cos(angle), std::sin(angle), 0.0);
      cloud.positions.push_back(normal + 0.105 * row * Vec3::UnitZ());
      cloud.normals.push_back(normal);
    }
  }
  const std::vector<std::uint32_t> found = boundary_of(cloud);
  EXPECT_GT(found.size(), 300u);  // of the 600 of the first and the last row
  for (const std::uint32_t i : found) {
    const double z = cloud.positions[i].z();
    EXPECT_LT(std::min(z, 59 * 0.105 - z), 0.15);
  }
}

TEST(Boundary, OfGroundAroundAScannerIsNotBetweenItsRows) {
  PointCloud cloud;
  cloud.positions = scanned_ground();
  const std::vector<std::uint32_t> found = boundary_of(cloud);
  EXPECT_GT(found.size(), 500u);  // of the 1,000 of the first and the last row
  for (const std::uint32_t i : found) {
    const Vec3& p = cloud.positions[i];
    const double away = std::hypot(p.x(), p.y()), turn = std::atan2(p.y(), p.x());
    const double to_side = away * std::min(turn, 2.0 - turn);
    const double to_end = std::min(away - kNearestGround, kFarthestGround - away);
    EXPECT_LT(std::min(to_side, to_end), 2.0) << p.transpose();
  }
}

TEST(Boundary, OfAThinWallIsNone) {
  PointCloud wall;  // a slab less than two spacings thick
  Random random(4);
  constexpr double kThick = 0.03;
  while (wall.size() < 9000) {
    Vec3 p = uniform_vector(random, Vec3::Zero(), {1.0, 1.0, kThick});
    const bool side = random.uniform() < 4.0 * kThick / (2.0 + 4.0 * kThick);
    const auto axis = side ? static_cast<Eigen::Index>(random.index(2)) : Eigen::Index{2};
    const bool up = random.index(2) == 1;
    p[axis] = up ? (side ? 1.0 : kThick) : 0.0;
    wall.positions.push_back(p);
    wall.normals.push_back((up ? 1.0 : -1.0) * Vec3::Unit(axis));
  }
  EXPECT_LT(share_found(wall), 0.003);
}

TEST(Boundary, DoesNotDependOnTheOrderOfThePoints) {
  const PointCloud cloud = sheet(2000);
  std::vector<std::size_t> order(cloud.size());
  std::iota(order.begin(), order.end(), 0u);
  Random(3).shuffle(std::span(order));
  PointCloud shuffled;
  for (const std::size_t i : order) {
    shuffled.positions.push_back(cloud.positions[i]);
    shuffled.normals.push_back(cloud.normals[i]);
  }
  std::vector<std::uint32_t> found;
  for (const std::uint32_t i : boundary_of(shuffled)) {
    found.push_back(static_cast<std::uint32_t>(order[i]));
  }
  std::sort(found.begin(), found.end());
  EXPECT_EQ(found, boundary_of(cloud));
}

TEST(Boundary, DoesNotDependOnTheSignsOfTheNormals) {
  PointCloud cloud = sheet(2000);
  const auto before = boundary_of(cloud);
  for (Vec3& normal : cloud.normals) normal = -normal;
  EXPECT_EQ(boundary_of(cloud), before);
}

TEST(Boundary, DoesNotDependOnTheThreads) {
  const PointCloud cloud = sheet(5000);
  const auto all = boundary_of(cloud);
  set_thread_count(1);
  const auto one = boundary_of(cloud);
  set_thread_count(0);
  EXPECT_EQ(one, all);
}

TEST(Boundary, DoesNotDependOnTheOrigin) {
  PointCloud cloud = sheet(2000);
  for (Vec3& p : cloud.positions) p = p.cast<float>().cast<double>();
  const auto before = boundary_of(cloud);
  for (Vec3& p : cloud.positions) p += Vec3(1024.0, -4096.0, 65536.0);  // exact
  EXPECT_EQ(boundary_of(cloud), before);
}

TEST(Boundary, HoldsAllCopiesOfAPoint) {
  PointCloud cloud = sheet(2000);
  const auto once = boundary_of(cloud);
  const std::size_t points = cloud.size();
  for (std::size_t i = 0; i < points; ++i) {
    cloud.positions.push_back(cloud.positions[i]);
    cloud.normals.push_back(cloud.normals[i]);
  }
  auto expected = once;
  for (const std::uint32_t i : once) expected.push_back(i + static_cast<std::uint32_t>(points));
  EXPECT_EQ(boundary_of(cloud), expected);
}

TEST(Boundary, OfFewPointsOrALineIsNone) {
  PointCloud few = sheet(10);
  EXPECT_TRUE(boundary_of(few).empty());
  PointCloud line;
  for (int i = 0; i < 100; ++i) {
    line.positions.push_back(0.01 * i * Vec3::UnitX());
    line.normals.push_back(Vec3::UnitZ());
  }
  EXPECT_TRUE(boundary_of(line).empty());
}

TEST(Boundary, IsMarkedOverTheNetworksClassesButNotOnPointsThatAreNowhere) {
  PointCloud cloud = sheet(2000);
  cloud.positions.push_back(Vec3::Constant(std::numeric_limits<double>::quiet_NaN()));
  cloud.normals.push_back(Vec3::UnitZ());
  const PreparedCloud prepared = prepare(cloud);
  Classification found = nothing_found(cloud.size());
  std::fill(found.classes.begin(), found.classes.end() - 1, kSharpEdge);
  mark_boundary(prepared, found);
  const auto boundary = find_boundary(prepared);
  EXPECT_EQ(found.counts.boundary, boundary.size());
  EXPECT_EQ(found.counts.sharp, 2000 - boundary.size());
  EXPECT_EQ(found.counts.unlabelled, 1u);
  for (const BoundaryPoint& its : boundary) EXPECT_EQ(found.classes[its.point], kBoundary);
}

TEST(Boundary, IsMarkedOnEdgesOnlyWhereItIsClear) {
  const std::vector<BoundaryPoint> boundary = {{0, true}, {1, false}, {2, true}, {3, false}};
  std::vector<std::uint8_t> classes = {kSharpEdge, kSharpEdge, kNonEdge, kUnlabelled, kSmoothEdge};
  mark_boundary(boundary, classes);
  const std::vector<std::uint8_t> expected = {kBoundary, kSharpEdge, kBoundary, kBoundary,
                                              kSmoothEdge};
  EXPECT_EQ(classes, expected);
}

TEST(Boundary, IsClearWithoutNoiseOnly) {
  const auto share_clear = [](double noise) {
    const PointCloud cloud = sheet(5000, noise);
    const auto boundary = find_boundary(prepare(cloud));
    const auto clear = std::count_if(boundary.begin(), boundary.end(),
                                     [](const BoundaryPoint& its) { return its.clear; });
    return static_cast<double>(clear) / static_cast<double>(boundary.size());
  };
  EXPECT_EQ(share_clear(0.0), 1.0);
  EXPECT_LT(share_clear(0.7), 0.2);
}

TEST(Boundary, OfACloudWithOtherNormalsIsRefused) {
  const PointCloud cloud = sheet(500, 0.0);
  for (const std::size_t normals : {0u, 499u}) {
    PreparedCloud prepared = prepare(cloud);
    prepared.normals = prepared.normals.first(normals);
    EXPECT_ERROR(ErrorKind::kUsage, find_boundary(prepared));
    EXPECT_ERROR(ErrorKind::kUsage, classify(prepared, EdgeModel{}));
    const std::vector<std::uint8_t> labels(500, kSharpEdge);
    std::vector<TrainingCloud> clouds;
    clouds.push_back({"sheet", std::move(prepared), labels});
    EXPECT_ERROR(ErrorKind::kUsage, make_samples(clouds, {}));
  }
}

TEST(Boundary, OfAnotherCloudIsRefused) {
  PointCloud cloud = sheet(500, 0.0);
  const PreparedCloud prepared = prepare(cloud);
  for (const std::size_t points : {0u, 499u, 501u}) {
    Classification found = nothing_found(points);
    EXPECT_ERROR(ErrorKind::kUsage, mark_boundary(prepared, found));
    EXPECT_ERROR(ErrorKind::kUsage, add_result(cloud, prepared, found, EdgeModel{}));
  }
}

}  // namespace
}  // namespace pcednet::detect
