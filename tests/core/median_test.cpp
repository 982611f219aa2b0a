#include "pcednet/core/median.h"

#include <gtest/gtest.h>

#include <algorithm>

#include "pcednet/core/random.h"

namespace pcednet {
namespace {

TEST(Median, IsTheMiddleValueOrTheMeanOfTheMiddleTwo) {
  EXPECT_EQ(median({}), 0.0);
  EXPECT_EQ(median({7}), 7.0);
  EXPECT_EQ(median({9, 1}), 5.0);
  EXPECT_EQ(median({9, 1, 2}), 2.0);
  EXPECT_EQ(median({4, 1, 100, 2}), 3.0);
  EXPECT_EQ(median({-1, -1, 5, 5, 5}), 5.0);
}

TEST(UpperMedian, IsTheMiddleValueOrTheUpperOfTheMiddleTwo) {
  EXPECT_EQ(upper_median(std::vector<float>{7}), 7.0f);
  EXPECT_EQ(upper_median(std::vector<float>{9, 1}), 9.0f);
  EXPECT_EQ(upper_median(std::vector<double>{9, 1, 2}), 2.0);
  EXPECT_EQ(upper_median(std::vector<double>{4, 1, 100, 2}), 4.0);
}

TEST(ValueAtRank, IsTheOneThatSortingPutsThere) {
  std::vector<int> values = {9, 1, 5, 1, 7};
  for (const auto& [rank, value] : {std::pair{4, 9}, {0, 1}, {1, 1}, {2, 5}, {3, 7}}) {
    EXPECT_EQ(value_at_rank(values, static_cast<std::size_t>(rank)), value);
  }
}

TEST(Median, HasHalfOfTheValuesOnEitherSide) {
  Random random(3);
  for (const std::size_t count : {99u, 100u}) {
    std::vector<double> values(count);
    for (double& value : values) value = random.normal();
    const auto below = [&](double limit) {
      return std::count_if(values.begin(), values.end(), [&](double v) { return v < limit; });
    };
    EXPECT_EQ(below(median(values)), count == 99 ? 49 : 50);
    EXPECT_EQ(below(upper_median(values)), count == 99 ? 49 : 50);
  }
}

}  // namespace
}  // namespace pcednet
