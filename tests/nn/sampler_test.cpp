#include "pcednet/nn/sampler.h"

#include <gtest/gtest.h>

#include <array>
#include <cmath>
#include <numeric>

namespace pcednet::nn {
namespace {

/// 900 samples of class 0 and 100 of class 1.
Sampler sampler(double balance) {
  std::vector<std::uint32_t> many(900), few(100);
  std::iota(many.begin(), many.end(), 0u);
  std::iota(few.begin(), few.end(), 900u);
  return Sampler({many, {}, few}, balance, Random(1, 2));
}

double share_of_the_few(double balance) {
  Sampler stream = sampler(balance);
  std::vector<std::uint32_t> batch(40000);
  stream.next(batch);
  double few = 0;
  for (const std::uint32_t index : batch) few += index >= 900;
  return few / static_cast<double>(batch.size());
}

TEST(Sampler, GivesTheClassesTheSharesThatBalanceAsksFor) {
  EXPECT_NEAR(share_of_the_few(0.0), 0.1, 1e-9);
  EXPECT_NEAR(share_of_the_few(1.0), 0.5, 1e-9);
  EXPECT_NEAR(share_of_the_few(0.5), 10.0 / (10.0 + 30.0), 1e-4);
}

TEST(Sampler, ShowsEverySampleOfTheLargestClassOnceARound) {
  for (const double balance : {0.0, 0.5, 1.0}) {
    Sampler stream = sampler(balance);
    std::vector<std::uint32_t> batch(stream.round());
    stream.next(batch);
    std::array<int, 1000> seen = {};
    for (const std::uint32_t index : batch) ++seen[index];
    for (std::size_t i = 0; i < 900; ++i) EXPECT_LE(seen[i], 1) << balance;
    EXPECT_NEAR(std::accumulate(seen.begin(), seen.begin() + 900, 0), 900, 1) << balance;
  }
}

}  // namespace
}  // namespace pcednet::nn
