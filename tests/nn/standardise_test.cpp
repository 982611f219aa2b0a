#include "pcednet/nn/standardise.h"

#include <gtest/gtest.h>

#include <cmath>
#include <limits>

#include "reference.h"

namespace pcednet::nn {
namespace {

/// One scale of three features; `labels` taken in turn.
std::vector<std::uint8_t> labels_in_turn(std::size_t count, std::size_t classes) {
  std::vector<std::uint8_t> labels(count);
  for (std::size_t i = 0; i < count; ++i) labels[i] = static_cast<std::uint8_t>(i % classes);
  return labels;
}

TEST(Standardise, MeasuresMeanAndDeviation) {
  std::vector<float> samples = random_numbers(30000, 1);
  for (std::size_t i = 0; i < samples.size(); i += 3) samples[i] = 7.0f + 0.01f * samples[i];
  const auto labels = labels_in_turn(10000, 2);
  const Standardisation s = measure_standardisation({samples, labels}, 1, 3, {});
  // The standard error of a mean of 10000 is 0.01 deviations; the cut tails take 2 % off these.
  EXPECT_NEAR(s.mean[0], 7.0f, 5e-4f);
  EXPECT_NEAR(0.01f * s.inverse_deviation[0], 1.0f, 0.05f);
  EXPECT_NEAR(s.mean[1], 0.0f, 0.05f);
  EXPECT_NEAR(s.inverse_deviation[1], 1.0f, 0.05f);
}

TEST(Standardise, IsNotMovedByAFewWildValues) {
  std::vector<float> samples = random_numbers(30000, 1);
  samples[3] = 1e30f;
  samples[6] = std::numeric_limits<float>::infinity();
  samples[9] = -std::numeric_limits<float>::infinity();
  samples[12] = NAN;
  const auto labels = labels_in_turn(10000, 2);
  const Standardisation s = measure_standardisation({samples, labels}, 1, 3, {});
  EXPECT_NEAR(s.mean[0], 0.0f, 0.05f);
  EXPECT_NEAR(s.inverse_deviation[0], 1.0f, 0.05f);
}

TEST(Standardise, CountsEveryClassTheSame) {
  // Class 1 is one sample in a hundred and lies at 10.
  std::vector<float> samples(30000);
  std::vector<std::uint8_t> labels(10000, 0);
  for (std::size_t i = 0; i < 10000; i += 100) {
    labels[i] = 1;
    samples[3 * i] = 10.0f;
  }
  const Standardisation s = measure_standardisation({samples, labels}, 1, 3, {});
  EXPECT_NEAR(s.mean[0], 5.0f, 1e-5f);
  EXPECT_NEAR(s.inverse_deviation[0], 0.2f, 1e-6f);
}

TEST(Standardise, KeepsOddFeaturesAboutZero) {
  std::vector<float> samples(3000, 3.0f);
  const std::vector<std::uint8_t> odd = {1, 0, 0};
  const Standardisation s = measure_standardisation({samples, labels_in_turn(1000, 2)}, 1, 3, odd);
  EXPECT_EQ(s.mean[0], 0.0f);
  EXPECT_NEAR(s.inverse_deviation[0], 1.0f / 3.0f, 1e-6f);
  EXPECT_EQ(s.mean[1], 3.0f);
}

TEST(Standardise, BoundsTheFactorOfConstantInputs) {
  const std::vector<float> samples(30, 0.25f);
  const Standardisation s = measure_standardisation({samples, labels_in_turn(10, 2)}, 1, 3, {});
  for (const float factor : s.inverse_deviation) EXPECT_FLOAT_EQ(factor, 1e6f);
  const Standardisation none = measure_standardisation({{}, {}}, 1, 3, {});
  for (const float mean : none.mean) EXPECT_EQ(mean, 0.0f);
}

}  // namespace
}  // namespace pcednet::nn
