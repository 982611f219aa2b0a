#include "pcednet/normals/local_counts.h"

#include <gtest/gtest.h>

#include <cmath>
#include <vector>

#include "pcednet/core/random.h"
#include "pcednet/normals/estimate.h"

namespace pcednet::normals {
namespace {

/// Level ground with noise for x < 60, and clean ripples beyond; spacing 1.
std::vector<Vec3> ground_and_ripples() {
  Random random(4);
  std::vector<Vec3> positions;
  for (int i = 0; i < 6000; ++i) {
    const double x = 100 * random.uniform(), y = 60 * random.uniform();
    const double z = x < 60 ? 0.5 * random.normal() : std::cos(0.7 * x);
    positions.emplace_back(x, y, z);
  }
  return positions;
}

TEST(LocalCounts, AreManyInNoiseAndFewWhereTheSurfaceBends) {
  const NeighbourGraph graph = make_neighbour_graph(ground_and_ripples());
  ASSERT_TRUE(graph.choice.noisy);
  const std::vector<std::uint32_t> counts = local_counts(graph);
  std::size_t many = 0, few = 0, ground = 0, ripples = 0;
  for (std::size_t i = 0; i < counts.size(); ++i) {
    const double x = graph.points[i].x();
    if (x < 50) ++ground, many += counts[i] == 48 ? 1 : 0;
    if (x > 70) ++ripples, few += counts[i] == 12 ? 1 : 0;
  }
  EXPECT_EQ(many, ground);
  EXPECT_EQ(few, ripples);
}

TEST(LocalCounts, OfAPartAreThoseOfTheWhole) {
  const NeighbourGraph whole = make_neighbour_graph(ground_and_ripples());
  const std::vector<std::uint32_t> of_whole = local_counts(whole);
  std::vector<Vec3> part;
  std::vector<std::uint32_t> expected;
  for (std::size_t i = 0; i < whole.points.size(); ++i) {
    if (whole.points[i].x() < 35) continue;
    part.push_back(whole.points[i]);
    expected.push_back(of_whole[i]);
  }
  const NeighbourGraph graph = make_neighbour_graph(part, whole.choice);
  const std::vector<std::uint32_t> counts = local_counts(graph);
  std::size_t inner = 0;
  for (std::size_t i = 0; i < part.size(); ++i) {
    // Three times the radius of 48 neighbours, 4 to 5 spacings, inside the cut.
    if (part[i].x() < 50) continue;
    ++inner;
    EXPECT_EQ(counts[graph.point_of[i]], expected[i]);
  }
  EXPECT_GT(inner, 2000u);
}

TEST(LocalCounts, AreManyWhereTheNearestLieAlongALine) {
  std::vector<Vec3> positions = ground_and_ripples();
  for (int line = 0; line < 3; ++line) {
    for (int i = 0; i < 200; ++i) positions.emplace_back(200 + 0.25 * i, 4.0 * line, 0.0);
  }
  const NeighbourGraph graph = make_neighbour_graph(positions);
  ASSERT_EQ(graph.choice.fewest, 12u);
  const std::vector<std::uint32_t> counts = local_counts(graph);
  for (std::size_t i = 0; i < counts.size(); ++i) {
    EXPECT_TRUE(graph.points[i].x() < 199 || counts[i] == 48) << i;
  }
  for (const Vec3& normal : estimate_normals(graph)) EXPECT_FALSE(normal.isZero(0.0));
}

TEST(LocalCounts, AreTheChoiceUnlessItIsNoisy) {
  const std::vector<Vec3> positions = ground_and_ripples();
  for (const std::uint32_t count :
       local_counts(make_neighbour_graph(positions, given_neighbours(20)))) {
    ASSERT_EQ(count, 20u);
  }
  EXPECT_TRUE(local_counts({}).empty());
}

}  // namespace
}  // namespace pcednet::normals
