#include "pcednet/spatial/detail_tree.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <map>
#include <numeric>
#include <set>

#include "pcednet/core/parallel.h"
#include "pcednet/core/random.h"
#include "pcednet/spatial/morton.h"

namespace pcednet::spatial {
namespace {

using Cell = std::array<std::uint32_t, 3>;

constexpr std::uint32_t kSide = 1U << 21;

std::vector<TreePoint> tree_points(const std::vector<Cell>& cells) {
  std::vector<TreePoint> points;
  for (const Cell& cell : cells) {
    points.push_back({morton_code(cell), 0, static_cast<std::uint32_t>(points.size())});
  }
  return points;
}

/// A slope with a dense corner, and a few points anywhere.
std::vector<Cell> slope(std::size_t count, std::uint64_t seed) {
  Random random(seed);
  std::vector<Cell> cells;
  for (std::size_t i = 0; i < count; ++i) {
    const std::uint32_t side = i % 3 == 0 ? kSide / 50 : kSide;
    const auto x = static_cast<std::uint32_t>(random.index(side)),
               y = static_cast<std::uint32_t>(random.index(side));
    const auto z = static_cast<std::uint32_t>(i % 100 == 0 ? random.index(kSide) : x / 4 + y / 8);
    cells.push_back({x, y, z});
  }
  return cells;
}

/// The node of every point.
std::vector<std::size_t> nodes_of(const DetailTree& tree) {
  std::vector<std::size_t> of_place;
  for (std::size_t n = 0; n < tree.nodes.size(); ++n) {
    of_place.insert(of_place.end(), tree.nodes[n].points, n);
  }
  std::vector<std::size_t> nodes;
  for (const std::uint32_t place : tree.places) nodes.push_back(of_place.at(place));
  return nodes;
}

Cell ancestor(const Cell& cell, int depth) {
  return {cell[0] >> (21 - depth), cell[1] >> (21 - depth), cell[2] >> (21 - depth)};
}

TEST(DetailTree, HoldsEveryPointInOneNodeThatContainsIt) {
  const std::vector<Cell> cells = slope(60'000, 1);
  const DetailTree tree = make_detail_tree(tree_points(cells), {.most = 2000, .least = 200});
  ASSERT_GT(tree.nodes.size(), 20U);
  std::vector<std::uint32_t> places = tree.places;
  std::sort(places.begin(), places.end());
  for (std::uint32_t i = 0; i < places.size(); ++i) ASSERT_EQ(places[i], i);
  const std::vector<std::size_t> nodes = nodes_of(tree);
  ASSERT_EQ(nodes.size(), cells.size());
  for (std::size_t i = 0; i < cells.size(); ++i) {
    const DetailNode& node = tree.nodes[nodes[i]];
    ASSERT_EQ(ancestor(cells[i], node.depth), node.cell);
  }
}

TEST(DetailTree, HasEveryNodesParentBeforeItAndNoNodeTwice) {
  const DetailTree tree =
      make_detail_tree(tree_points(slope(60'000, 2)), {.most = 2000, .least = 200});
  std::set<std::pair<int, Cell>> seen;
  int depth = 0;
  for (const DetailNode& node : tree.nodes) {
    EXPECT_GE(node.depth, depth);
    depth = node.depth;
    EXPECT_TRUE(seen.emplace(node.depth, node.cell).second);
    const Cell parent = {node.cell[0] / 2, node.cell[1] / 2, node.cell[2] / 2};
    EXPECT_TRUE(node.depth == 0 || seen.count({node.depth - 1, parent}) == 1);
  }
  EXPECT_GT(depth, 2);
}

// The definition, point by point: of each voxel of the root the point nearest to its centre.
TEST(DetailTree, KeepsInItsRootThePointsNearestToTheCentresOfVoxels) {
  const std::vector<Cell> cells = slope(60'000, 3);
  const DetailTree tree = make_detail_tree(tree_points(cells), {.most = 50'000, .least = 0});
  constexpr double kVoxel = kSide / 128.0;
  std::map<Cell, double> nearest;
  const auto distance = [&](const Cell& cell) {
    double sum = 0.0;
    for (const std::uint32_t c : cell) {
      const double off = c + 0.5 - (std::floor(c / kVoxel) + 0.5) * kVoxel;
      sum += off * off;
    }
    return sum;
  };
  for (const Cell& cell : cells) {
    const auto [found, is_new] = nearest.emplace(ancestor(cell, 7), distance(cell));
    found->second = std::min(found->second, distance(cell));
  }
  std::size_t kept = 0;
  const std::vector<std::size_t> nodes = nodes_of(tree);
  for (std::size_t i = 0; i < cells.size(); ++i) {
    if (nodes[i] != 0) continue;
    ++kept;
    EXPECT_EQ(distance(cells[i]), nearest.at(ancestor(cells[i], 7)));
  }
  EXPECT_EQ(kept, nearest.size());
  EXPECT_GT(tree.nodes.size(), 1U);
}

TEST(DetailTree, CoarsensTheVoxelsOfANodeThatWouldKeepTooMany) {
  Random random(4);
  std::vector<Cell> cells;
  for (int i = 0; i < 100'000; ++i) {  // a volume, nearly as many of 128^3 voxels
    Cell& cell = cells.emplace_back();
    for (std::uint32_t& c : cell) c = static_cast<std::uint32_t>(random.index(kSide));
  }
  const DetailTree tree = make_detail_tree(tree_points(cells), {.most = 40'000, .least = 100});
  EXPECT_LE(tree.nodes[0].points, 40'000U);
  EXPECT_GE(tree.nodes[0].points, 20'000U);
  EXPECT_EQ(tree.places.size(), cells.size());
}

TEST(DetailTree, HasNodesOfSensibleSizes) {
  const std::vector<Cell> cells = slope(1'000'000, 5);
  const auto small_leaves = [](const DetailTree& tree) {
    std::set<std::pair<int, Cell>> parents;
    for (const DetailNode& node : tree.nodes) {
      parents.emplace(node.depth - 1, Cell{node.cell[0] / 2, node.cell[1] / 2, node.cell[2] / 2});
    }
    return std::count_if(tree.nodes.begin(), tree.nodes.end(), [&](const DetailNode& node) {
      return node.points < 10'000 && parents.count({node.depth, node.cell}) == 0;
    });
  };
  const DetailTree merged = make_detail_tree(tree_points(cells));
  const DetailTree apart = make_detail_tree(tree_points(cells), {.least = 0});
  for (const DetailNode& node : merged.nodes) EXPECT_LE(node.points, 100'000U);
  EXPECT_GT(small_leaves(apart), 5);
  EXPECT_EQ(small_leaves(merged), 0);
}

TEST(DetailTree, IsTheSameForAnyOrderOfThePointsAndAnyNumberOfThreads) {
  std::vector<Cell> cells = slope(30'000, 6);
  for (std::size_t i = 0; i < 1000; ++i) cells.push_back(cells[i]);  // the tie decides
  std::vector<TreePoint> points = tree_points(cells);
  for (TreePoint& p : points) p.tie = p.index * 2654435761U;
  constexpr DetailTreeOptions kOptions{.most = 1500, .least = 100};
  const DetailTree wanted = make_detail_tree(points, kOptions);
  Random random(7);
  for (const int threads : {1, 2, 8}) {
    set_thread_count(threads);
    std::vector<TreePoint> shuffled = points;
    random.shuffle(std::span(shuffled));
    const DetailTree tree = make_detail_tree(shuffled, kOptions);
    EXPECT_EQ(tree.places, wanted.places);
    ASSERT_EQ(tree.nodes.size(), wanted.nodes.size());
    for (std::size_t n = 0; n < tree.nodes.size(); ++n) {
      EXPECT_EQ(tree.nodes[n].cell, wanted.nodes[n].cell);
      EXPECT_EQ(tree.nodes[n].points, wanted.nodes[n].points);
    }
  }
  set_thread_count(0);
}

TEST(DetailTree, EndsWhereManyPointsCoincide) {
  const std::vector<Cell> cells(3'000'000, Cell{kSide - 1, 0, 12345});
  const DetailTree tree = make_detail_tree(tree_points(cells));
  EXPECT_EQ(tree.nodes.back().depth, 19);
  EXPECT_EQ(tree.nodes.back().cell, ancestor(cells[0], 19));
  EXPECT_LE(tree.nodes.back().points, std::size_t{1} << 20);
  std::size_t points = 0;
  for (const DetailNode& node : tree.nodes) points += node.points;
  EXPECT_EQ(points, cells.size());
}

TEST(DetailTree, IsARootOfNoPointsForNone) {
  const DetailTree tree = make_detail_tree({});
  ASSERT_EQ(tree.nodes.size(), 1U);
  EXPECT_EQ(tree.nodes[0].depth, 0);
  EXPECT_EQ(tree.nodes[0].points, 0U);
  EXPECT_TRUE(tree.places.empty());
}

}  // namespace
}  // namespace pcednet::spatial
