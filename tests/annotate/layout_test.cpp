#include "workbench/annotate/scene/layout.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cstring>
#include <limits>

#include "pcednet/core/random_vectors.h"

namespace pcednet::annotate {
namespace {

std::vector<Vec3> random_points(std::size_t count, double scale = 1.0) {
  Random random(7);
  std::vector<Vec3> points(count);
  for (Vec3& p : points) p = uniform_vector(random, Vec3::Zero(), {1.0, 1.0, 0.3}) * scale;
  return points;
}

TEST(Layout, HoldsEveryFinitePointOnceWithinItsCube) {
  auto points = random_points(300000);
  points[17].x() = std::numeric_limits<double>::quiet_NaN();
  const Layout layout = make_layout(points, 0.01);
  std::vector<int> seen(points.size(), 0);
  std::size_t total = 0;
  for (std::size_t id = 0; id < layout.nodes.size(); ++id) {
    const Node& node = layout.nodes[id];
    EXPECT_LE(node.points, kMostNodePoints);
    EXPECT_EQ(node.first, total);
    total += node.points;
    for (std::size_t i = node.first; i < node.first + node.points; ++i) {
      const std::uint32_t point = layout.order[i];
      ++seen[point];
      EXPECT_EQ(layout.node_of[point], id);
      EXPECT_LE((points[point] - node.centre).cwiseAbs().maxCoeff(), node.half * (1 + 1e-6));
    }
  }
  EXPECT_EQ(layout.node_of[17], kNoNode);
  seen[17] += 1;
  EXPECT_TRUE(std::all_of(seen.begin(), seen.end(), [](int n) { return n == 1; }));
  EXPECT_EQ(total, points.size() - 1);
  EXPECT_GT(layout.nodes.size(), 5u);
}

TEST(Layout, GivesFarPointsACubeOfTheirOwn) {
  std::vector<Vec3> points = random_points(5000);
  points[7] = Vec3(-4e5, -5e6, 0);
  const Layout layout = make_layout(points, 0.01);
  ASSERT_EQ(layout.nodes.size(), 2u);
  EXPECT_LT(layout.nodes[0].half, 1.0);
  EXPECT_EQ(layout.nodes[0].points, points.size() - 1);
  EXPECT_EQ(layout.nodes[0].children, std::vector<std::uint32_t>{1});
  EXPECT_EQ(layout.node_of[7], 1u);
  EXPECT_LT((layout.nodes[1].centre - points[7]).norm(), 1e-6);
}

TEST(Layout, BeginsEveryNodeWithAnEvenSample) {
  const auto points = random_points(200000);
  const Layout layout = make_layout(points, 0.01);
  // Of the root's first 4096 points each quarter of the square has about a quarter.
  std::array<int, 4> quarters = {};
  for (std::size_t i = 0; i < 4096; ++i) {
    const Vec3& p = points[layout.order[i]];
    ++quarters[(p.x() > 0.5 ? 1u : 0u) + (p.y() > 0.5 ? 2u : 0u)];
  }
  for (const int count : quarters) EXPECT_NEAR(count, 1024, 100);
}

TEST(Layout, TakesMorePointsInOnePlaceThanANodeHolds) {
  const std::vector<Vec3> points(150000, Vec3(1e7, 2, 3));
  const Layout layout = make_layout(points, 0.0);
  EXPECT_EQ(layout.order.size(), points.size());
  for (const Node& node : layout.nodes) EXPECT_LE(node.points, kMostNodePoints);
}

TEST(Layout, OfNothingIsEmpty) {
  EXPECT_TRUE(make_layout({}, 1.0).nodes.empty());
}

TEST(Layout, EncodesPlacesToASixtyFiveThousandthOfTheCube) {
  const auto points = random_points(500, 1e6);
  const std::vector<Vec3> normals(500, Vec3(0, 0, -1));
  const std::vector<Rgb> colours(500, Rgb{1, 2, 3});
  const Layout layout = make_layout(points, 1.0);
  const Node& node = layout.nodes[0];
  const auto bytes = encode_points(layout, node, points, normals, colours);
  ASSERT_EQ(bytes.size(), 500u * 11);
  for (std::size_t i = 0; i < 500; ++i) {
    std::array<std::uint16_t, 3> place;
    std::memcpy(place.data(), bytes.data() + 6 * i, 6);
    for (int k = 0; k < 3; ++k) {
      const double x =
          node.centre[k] - node.half + place[static_cast<std::size_t>(k)] / 65535.0 * 2 * node.half;
      EXPECT_NEAR(x, points[layout.order[i]][k], node.half / 65535 * 1.01);
    }
    EXPECT_EQ(static_cast<std::int8_t>(bytes[3000 + 2 * i]), 127);  // (0,0,-1) is at a corner
  }
}

}  // namespace
}  // namespace pcednet::annotate
