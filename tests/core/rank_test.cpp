#include "pcednet/core/rank.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <limits>
#include <vector>

#include "pcednet/core/random.h"

namespace pcednet {
namespace {

TEST(Rank, IsTheNumberOfSmallerValues) {
  Random random(2);
  for (const std::size_t count : {0u, 1u, 7u, 8u, 9u, 100u}) {
    std::vector<double> values;
    for (std::size_t i = 0; i < count; ++i) values.push_back(static_cast<double>(random.index(20)));
    std::vector<double> padded = values;
    padded.resize(count + kRankStep, std::numeric_limits<double>::infinity());
    std::vector<std::int64_t> ranks(count + kRankStep);
    rank(padded.data(), count, ranks.data());
    for (std::size_t i = 0; i < count; ++i) {
      const auto smaller = [&](double value) { return value < values[i]; };
      EXPECT_EQ(ranks[i], std::count_if(values.begin(), values.end(), smaller));
    }
  }
}

}  // namespace
}  // namespace pcednet
