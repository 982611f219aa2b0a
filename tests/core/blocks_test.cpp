#include "pcednet/core/blocks.h"

#include <gtest/gtest.h>

#include <utility>
#include <vector>

namespace pcednet {
namespace {

using Blocks = std::vector<std::pair<std::size_t, std::size_t>>;

Blocks blocks_of(std::size_t count, std::size_t block) {
  Blocks blocks;
  for_each_block(count, block,
                 [&](std::size_t begin, std::size_t end) { blocks.emplace_back(begin, end); });
  return blocks;
}

TEST(Blocks, CoverAllNumbersInOrder) {
  EXPECT_EQ(blocks_of(7, 3), (Blocks{{0, 3}, {3, 6}, {6, 7}}));
  EXPECT_EQ(blocks_of(6, 3), (Blocks{{0, 3}, {3, 6}}));
  EXPECT_EQ(blocks_of(2, 3), (Blocks{{0, 2}}));
  EXPECT_TRUE(blocks_of(0, 3).empty());
}

}  // namespace
}  // namespace pcednet
