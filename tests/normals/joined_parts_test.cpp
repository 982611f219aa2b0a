#include "pcednet/normals/joined_parts.h"

#include <gtest/gtest.h>

#include <numeric>

#include "pcednet/core/random.h"

namespace pcednet::normals {
namespace {

/// A forest: every row joins one of smaller rank, or one of equal rank that joins it.
struct Forest {
  std::vector<Join> joins;
  std::vector<std::int8_t> sign;  ///< of the rows, up to one sign for each tree
};

Forest make_forest(std::uint32_t rows, std::uint32_t trees, Random& random) {
  std::vector<std::uint32_t> rank(rows);
  std::iota(rank.begin(), rank.end(), 0u);
  for (std::uint32_t i = rows; i > 1; --i) std::swap(rank[i - 1], rank[random.index(i)]);
  Forest forest = {std::vector<Join>(rows), std::vector<std::int8_t>(rows)};
  for (std::int8_t& sign : forest.sign) sign = random.index(2) == 0 ? 1 : -1;
  for (std::uint32_t k = 0; k < rows; ++k) {
    const std::uint32_t row = rank[k];
    // Long chains, and now and then a branch.
    const std::uint32_t parent = random.index(4) == 0 ? random.index(std::max(k, 1u)) : k - 1;
    const std::uint32_t to = k < trees ? row : rank[parent];
    forest.joins[row] = {to, static_cast<std::int8_t>(forest.sign[row] * forest.sign[to])};
  }
  for (std::uint32_t k = 0; k < trees; k += 2) {  // half of the roots join back
    for (std::uint32_t i = 0; i < rows; ++i) {
      if (i == rank[k] || forest.joins[i].to != rank[k]) continue;
      forest.joins[rank[k]] = {i, forest.joins[i].sign};
      break;
    }
  }
  return forest;
}

TEST(JoinedParts, AreWhatStepsAlongTheJoinsReach) {
  Random random(1);
  const std::uint32_t kRows = 50000;
  const Forest forest = make_forest(kRows, 20, random);
  const Signs signs = follow_joins(forest.joins);
  std::vector<std::uint32_t> part_of_root(kRows, kRows), first_of_part;
  for (std::uint32_t i = 0; i < kRows; ++i) {
    std::uint32_t root = i;
    while (forest.joins[root].to != root) {
      if (forest.joins[forest.joins[root].to].to == root) {
        root = std::min(root, forest.joins[root].to);
        break;
      }
      root = forest.joins[root].to;
    }
    if (part_of_root[root] == kRows) {
      part_of_root[root] = static_cast<std::uint32_t>(first_of_part.size());
      first_of_part.push_back(i);
    }
    ASSERT_EQ(signs.part[i], part_of_root[root]);
    ASSERT_EQ(signs.sign[i], forest.sign[i] * forest.sign[first_of_part[signs.part[i]]]);
  }
  EXPECT_EQ(signs.parts, 20u);
  EXPECT_EQ(first_of_part.size(), 20u);
}

TEST(JoinedParts, JoinAgainAsTheirParts) {
  Signs finer = {{1, 1, -1, 1}, {0, 1, 1, 2}, 3};
  const Signs coarser = {{1, 1, -1}, {0, 1, 0}, 2};
  join_again(finer, coarser);
  EXPECT_EQ(finer.parts, 2u);
  EXPECT_EQ(finer.part, (std::vector<std::uint32_t>{0, 1, 1, 0}));
  EXPECT_EQ(finer.sign, (std::vector<std::int8_t>{1, 1, -1, -1}));
}

TEST(JoinedParts, NoneOfNone) {
  EXPECT_EQ(follow_joins({}).parts, 0u);
}

}  // namespace
}  // namespace pcednet::normals
