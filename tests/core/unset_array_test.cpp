#include "pcednet/core/unset_array.h"

#include <gtest/gtest.h>

#include <numeric>
#include <span>
#include <utility>

namespace pcednet {
namespace {

TEST(UnsetArray, HoldsWhatIsWrittenAndIsEmptyOnceMoved) {
  UnsetArray<int> numbers(1000);
  ASSERT_EQ(numbers.size(), 1000u);
  std::iota(numbers.begin(), numbers.end(), 0);
  const std::span<const int> view = numbers;
  EXPECT_EQ(std::accumulate(view.begin(), view.end(), 0), 499500);
  UnsetArray<int> moved = std::move(numbers);
  EXPECT_EQ(moved[999], 999);
  EXPECT_EQ(moved.data(), view.data());
  EXPECT_EQ(numbers.size(), 0u);  // NOLINT(bugprone-use-after-move): what is left
  EXPECT_EQ(numbers.begin(), numbers.end());
  moved = {};
  EXPECT_EQ(moved.size(), 0u);
}

}  // namespace
}  // namespace pcednet
