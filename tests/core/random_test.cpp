#include "pcednet/core/random.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <numeric>

namespace pcednet {
namespace {

TEST(Random, RepeatsItselfForTheSameSeed) {
  Random a(7), b(7), c(8), d(7, 1);
  for (int i = 0; i < 100; ++i) {
    const auto value = a.next();
    EXPECT_EQ(value, b.next());
    EXPECT_NE(value, c.next());
    EXPECT_NE(value, d.next());
  }
}

TEST(Random, HasTheMomentsOfItsDistributions) {
  Random random(1);
  double sum = 0, squares = 0, uniform = 0;
  constexpr int kCount = 200000;
  for (int i = 0; i < kCount; ++i) {
    const double value = random.normal();
    sum += value;
    squares += value * value;
    uniform += random.uniform();
  }
  EXPECT_NEAR(sum / kCount, 0.0, 0.01);
  EXPECT_NEAR(squares / kCount, 1.0, 0.015);
  EXPECT_NEAR(uniform / kCount, 0.5, 0.005);
}

TEST(Random, ShufflesToAPermutation) {
  std::array<int, 50> values;
  std::iota(values.begin(), values.end(), 0);
  const auto before = values;
  Random(3).shuffle(std::span<int>(values));
  EXPECT_NE(values, before);
  std::sort(values.begin(), values.end());
  EXPECT_EQ(values, before);
}

}  // namespace
}  // namespace pcednet
