#include "pcednet/detect/acute_edge.h"

#include <gtest/gtest.h>

#include <cmath>
#include <numbers>
#include <numeric>

#include "detect/labelled_cube.h"
#include "detect/left_part.h"
#include "pcednet/core/parallel.h"
#include "pcednet/detect/decide.h"
#include "pcednet/detect/result_cloud.h"

namespace pcednet::detect {
namespace {

constexpr double kDegrees = std::numbers::pi / 180.0;

gls::ScaleSpaceOptions with_gates(double gate, std::optional<double> second) {
  return {.side_gate = gate, .second_gate = second};
}

const gls::ScaleSpaceOptions kTwoGates = with_gates(0.4, -0.3);

/// Two squares of a unit edge, which meet in the x axis at an angle, in degrees; noise is relative
/// to the spacing.
PointCloud wedge(double angle, std::size_t points, double noise = 0.0) {
  Random random(7);
  PointCloud cloud;
  const double sigma = noise * std::sqrt(2.0 / static_cast<double>(points));
  for (std::size_t i = 0; i < points; ++i) {
    const double side = i % 2 == 0 ? 1.0 : -1.0, half = 0.5 * angle * kDegrees;
    const double x = random.uniform(), along = random.uniform();
    const Vec3 in_face(0.0, std::cos(half), side * std::sin(half));
    cloud.positions.push_back(Vec3(x, 0.0, 0.0) + along * in_face + sigma * normal_vector(random));
    cloud.normals.emplace_back(0.0, -std::sin(half), side * std::cos(half));
  }
  return cloud;
}

double distance_to_edge(const Vec3& p) {
  return std::hypot(p.y(), p.z());
}

std::vector<AcuteEdgePoint> edges_of(const PointCloud& cloud,
                                     const gls::ScaleSpaceOptions& descriptor = kTwoGates) {
  return find_acute_edges(prepare(cloud), descriptor);
}

void expect_edge(double angle, double noise) {
  constexpr std::size_t kPoints = 4000;
  const PointCloud cloud = wedge(angle, kPoints, noise);
  const double spacing = std::sqrt(2.0 / kPoints);
  std::size_t beside = 0, met = 0;
  std::vector<std::uint8_t> found(kPoints, 0);
  for (const AcuteEdgePoint& it : edges_of(cloud)) {
    const double distance = distance_to_edge(cloud.positions[it.point]) / spacing;
    EXPECT_LT(distance, 2.0 + 2.0 * noise);
    EXPECT_NEAR(it.distance, distance, 0.9 + noise);
    found[it.point] = 1;
  }
  for (std::size_t i = 0; i < kPoints; ++i) {
    const Vec3& p = cloud.positions[i];
    if (distance_to_edge(p) > 0.6 * spacing || std::abs(p.x() - 0.5) > 0.45) continue;
    ++beside;
    met += found[i];
  }
  EXPECT_GT(beside, 20u);
  EXPECT_GE(static_cast<double>(met), 0.88 * static_cast<double>(beside));
}

TEST(AcuteEdges, AreFoundAtAllAnglesThatTheGateHides) {
  for (const double angle : {20.0, 35.0, 50.0, 70.0}) {
    SCOPED_TRACE(angle);
    expect_edge(angle, 0.0);
    expect_edge(angle, 0.3);
  }
}

TEST(AcuteEdges, AreNotThoseThatTheNetworkSees) {
  EXPECT_TRUE(edges_of(wedge(75.0, 4000)).empty());
  EXPECT_TRUE(edges_of(cube(8000, 3)).empty());
}

TEST(AcuteEdges, AreNoneOfAThinPlateOrRod) {
  Random random(5);
  PointCloud plate, rod;
  for (int i = 0; i < 6000; ++i) {  // 3,000 to a side: a spacing of .018
    const double side = i % 2 == 0 ? 1.0 : -1.0;
    const double x = random.uniform(), y = random.uniform();
    plate.positions.emplace_back(x, y, 0.01 * side);
    plate.normals.push_back(side * Vec3::UnitZ());
    const double turn = random.uniform(0.0, 2.0 * std::numbers::pi);
    const Vec3 outwards(std::cos(turn), std::sin(turn), 0.0);
    rod.positions.push_back(0.03 * outwards + Vec3(0.0, 0.0, 8.0 * random.uniform()));
    rod.normals.push_back(outwards);
  }
  EXPECT_TRUE(edges_of(plate).empty());
  EXPECT_LT(edges_of(rod).size(), 12u);
}

TEST(AcuteEdges, AreHiddenByLooseGatesAloneAndByGivenNormals) {
  PointCloud cloud = wedge(40.0, 4000);
  EXPECT_FALSE(edges_of(cloud, with_gates(-0.3, {})).empty());
  EXPECT_TRUE(edges_of(cloud, {}).empty());
  EXPECT_TRUE(edges_of(cloud, with_gates(0.4, {})).empty());
  cloud = wedge(40.0, 4000, 0.3);
  cloud.normals.clear();
  EXPECT_TRUE(edges_of(cloud).empty());
}

TEST(AcuteEdges, DoNotDependOnOrderSignsOrThreads) {
  const PointCloud cloud = wedge(40.0, 3000, 0.2);
  const auto expected = edges_of(cloud);
  ASSERT_GT(expected.size(), 100u);
  PointCloud flipped = cloud;
  for (Vec3& normal : flipped.normals) normal = -normal;
  EXPECT_EQ(edges_of(flipped), expected);
  set_thread_count(1);
  EXPECT_EQ(edges_of(cloud), expected);
  set_thread_count(0);

  std::vector<std::uint32_t> order(cloud.size());
  std::iota(order.begin(), order.end(), 0u);
  Random(3).shuffle(std::span(order));
  PointCloud shuffled;
  for (const std::uint32_t i : order) {
    shuffled.positions.push_back(cloud.positions[i]);
    shuffled.normals.push_back(cloud.normals[i]);
  }
  auto found = edges_of(shuffled);
  for (AcuteEdgePoint& it : found) it.point = order[it.point];
  std::sort(found.begin(), found.end(),
            [](const auto& a, const auto& b) { return a.point < b.point; });
  EXPECT_EQ(found, expected);
}

TEST(AcuteEdges, OfAPartAreThoseOfTheLargeCloud) {
  const PointCloud cloud = wedge(40.0, 200000);
  const LeftPart half(cloud, 0.55);
  PreparedCloud prepared = prepare(half.cloud);
  prepared.part = &half.part;
  std::vector<AcuteEdgePoint> of_whole, of_part;
  for (const AcuteEdgePoint& it : edges_of(cloud)) {
    if (cloud.positions[it.point].x() < 0.5) of_whole.push_back(it);
  }
  for (const AcuteEdgePoint& it : find_acute_edges(prepared, kTwoGates)) {
    if (half.cloud.positions[it.point].x() >= 0.5) continue;
    of_part.push_back({half.numbers[it.point], it.distance});
  }
  EXPECT_GT(of_whole.size(), 300u);
  EXPECT_EQ(of_part, of_whole);
}

TEST(AcuteEdges, BecomeEdgesWhereTheNetworkFindsNone) {
  EdgeModel model;
  model.classes = {kNonEdge, kSmoothEdge, kSharpEdge};
  Classification found = nothing_found(4);
  found.classes = {kNonEdge, kNonEdge, kSmoothEdge, kNonEdge};
  found.p_smooth[2] = 0.6f;
  const std::vector<AcuteEdgePoint> points = {{0, 0.2f}, {1, 1.0f}, {2, 0.1f}, {3, 1.73f}};
  mark_acute_edges(points, model, found);
  EXPECT_EQ(found.classes,
            (std::vector<std::uint8_t>{kSharpEdge, kSmoothEdge, kSmoothEdge, kNonEdge}));
  EXPECT_GT(found.p_sharp[0], 0.9f);
  EXPECT_GT(found.p_smooth[1], 0.9f);
  EXPECT_EQ(found.p_smooth[2], 0.6f);

  model.classes = {kNonEdge, kSharpEdge};
  found = nothing_found(2);
  found.classes = {kNonEdge, kNonEdge};
  found.p_sharp[1] = 0.3f;
  mark_acute_edges(std::span(points).first(2), model, found);
  EXPECT_EQ(found.classes, (std::vector<std::uint8_t>{kSharpEdge, kNonEdge}));
  EXPECT_EQ(found.p_sharp[1], 0.3f);
  EXPECT_EQ(found.p_smooth[1], 0.0f);
}

}  // namespace
}  // namespace pcednet::detect
