#include "pcednet/nn/kernels.h"

#include <gtest/gtest.h>

#include <cmath>
#include <cstring>
#include <limits>

#include "pcednet/core/error.h"
#include "pcednet/nn/plan.h"
#include "reference.h"
#include "support/expect_error.h"

namespace pcednet::nn {
namespace {

/// Two classes of the given logits, a lane each, through softmax.
std::vector<float> softmax_of(const std::vector<float>& differences) {
  const int lanes = static_cast<int>(differences.size());
  LaneTable table(2, lanes);
  std::copy(differences.begin(), differences.end(), table.row(0));
  kernels().softmax(table.row(0), 2, lanes, false);
  return {table.row(0), table.row(0) + lanes};
}

/// From -100 to 100, and finer about zero.
std::vector<float> sweep() {
  std::vector<float> values(64 * 1024);
  for (std::size_t i = 0; i < values.size(); ++i) {
    const double t = 2.0 * static_cast<double>(i) / static_cast<double>(values.size()) - 1.0;
    values[i] = static_cast<float>(100.0 * t * t * t);
  }
  return values;
}

TEST(Kernels, ComputeTheSigmoid) {
  for (const int rows : {1, 2}) {  // alone, and as a pair that shares a division
    const std::vector<float> x = sweep();
    const int lanes = static_cast<int>(x.size()) / rows;
    LaneTable table(rows, lanes);
    std::copy(x.begin(), x.end(), table.row(0));
    kernels().activate(Activation::kSigmoid, table.row(0), rows, lanes);
    for (std::size_t i = 0; i < x.size(); ++i) {
      // Numbers up to 1, with the roundings of both denominators, their product, its inverse and
      // the last product: half an ulp (6e-8) each at most, seldom all in one direction.
      ASSERT_NEAR(table.row(0)[i], 1.0 / (1.0 + std::exp(-static_cast<double>(x[i]))), 2e-7)
          << x[i];
    }
  }
}

TEST(Kernels, SaturateTheSigmoidWithoutNaN) {
  const float infinity = std::numeric_limits<float>::infinity();
  LaneTable table(2, 32);
  for (int p = 0; p < 32; ++p) {
    table.row(0)[p] = p % 2 ? infinity : std::numeric_limits<float>::max();
    table.row(1)[p] = p % 2 ? -infinity : std::numeric_limits<float>::quiet_NaN();
  }
  kernels().activate(Activation::kSigmoid, table.row(0), 2, 32);
  for (int p = 0; p < 32; ++p) EXPECT_EQ(table.row(0)[p], 1.0f);
  for (int p = 1; p < 32; p += 2) EXPECT_NEAR(table.row(1)[p], 0.0f, 2e-13f);
  for (int p = 0; p < 32; p += 2) EXPECT_TRUE(std::isfinite(table.row(1)[p]));
}

TEST(Kernels, ComputeProbabilitiesToAFewUlp) {
  const std::vector<float> x = sweep();
  const std::vector<float> p = softmax_of(x);
  for (std::size_t i = 0; i < x.size(); ++i) {
    const double wanted = 1.0 / (1.0 + std::exp(-static_cast<double>(x[i])));
    if (std::abs(x[i]) > 85.0f) continue;  // beyond, the exponential saturates
    // Relative: small probabilities too. The exponential, a sum and a division.
    ASSERT_NEAR(p[i] / wanted, 1.0, 4e-7) << x[i];
  }
  EXPECT_NEAR(softmax_of(std::vector<float>(32, -100.0f))[0], 0.0f, 1e-37f);
}

TEST(Kernels, ComputeTheCrossEntropy) {
  const std::vector<float> x = sweep();
  const int lanes = static_cast<int>(x.size());
  LaneTable logits(2, lanes), deltas(2, lanes);
  std::copy(x.begin(), x.end(), logits.row(0));
  LaneTable targets(2, lanes);
  std::fill_n(targets.row(0), lanes, 1.0f);
  const std::vector<float> weights(x.size(), 1.0f);
  std::vector<float> losses(x.size());
  kernels().cross_entropy(logits.row(0), targets.row(0), weights.data(), 2, lanes, false,
                          losses.data(), deltas.row(0));
  for (std::size_t i = 0; i < x.size(); ++i) {
    const double wanted = std::log1p(std::exp(-static_cast<double>(x[i])));
    // The loss is a difference of numbers up to log 2 beside the logits'.
    ASSERT_NEAR(losses[i], wanted, 2e-7 * std::max(1.0, wanted)) << x[i];
    ASSERT_NEAR(deltas.row(0)[i] + deltas.row(1)[i], 0.0f, 1.2e-7f);
  }
}

TEST(Kernels, TransposeAnyNumberOfInputs) {
  for (const int inputs : {1, 3, 4, 6, 97}) {
    const std::vector<float> samples = random_numbers(32 * static_cast<std::size_t>(inputs), 1);
    std::vector<const float*> rows(32);
    for (int p = 0; p < 32; ++p) rows[static_cast<std::size_t>(p)] = samples.data() + p * inputs;
    LaneTable table(inputs, 32);
    kernels().transpose(rows.data(), inputs, table.row(0), 32, 32);
    for (int p = 0; p < 32; ++p) {
      for (int u = 0; u < inputs; ++u) {
        ASSERT_EQ(table.row(u)[p], samples[static_cast<std::size_t>(p * inputs + u)]);
      }
    }
  }
}

TEST(Kernels, ShareTheProductsOfMirroredInputs) {
  constexpr int kLanes = 64, kInputs = 10, kMostOutputs = 17;  // tiles of 6, 4, 2 and 1
  const std::vector<std::uint8_t> odd = {1, 0, 1, 1, 0, 1, 1, 1, 0, 1};
  const std::vector<float> parameters = random_numbers(kMostOutputs * (kInputs + 1), 2);
  const std::vector<float> inputs = random_numbers(kInputs * kLanes, 3);
  for (const InstructionSet instructions : usable_instruction_sets()) {
    const Kernels& its = kernels(instructions);
    for (const int outputs : {13, 16, kMostOutputs}) {
      AffineMap map{
          .outputs = outputs, .segments = 2, .length = 4, .weight_output_stride = kInputs};
      map.weight_segment_stride = 5;
      map.bias = kMostOutputs * kInputs;
      map.in_row = 1;
      map.in_segment_rows = 5;
      map.out_row = kInputs;
      LaneTable plain(kInputs + outputs, kLanes);
      std::copy(inputs.begin(), inputs.end(), plain.row(0));
      const SignPattern signs = {odd.data(), kInputs, 0, 1};
      its.mirror(signs, plain.row(0), kLanes);
      LaneTable shared = plain;
      its.forward(map, parameters.data(), plain.row(0), kLanes);
      its.forward_mirrored(map, signs, parameters.data(), shared.row(0), kLanes);
      EXPECT_NE(plain.row(kInputs)[0], 0.0f);
      EXPECT_EQ(std::memcmp(plain.row(0), shared.row(0),
                            sizeof(float) * kLanes * static_cast<std::size_t>(kInputs + outputs)),
                0)
          << outputs;
    }
  }
}

TEST(Kernels, RefuseInstructionsThatTheProcessorLacks) {
  if (instruction_set() == InstructionSet::kAvx512) {
    EXPECT_NO_THROW(kernels(InstructionSet::kAvx512));
  } else {
    EXPECT_ERROR(ErrorKind::kFailure, kernels(InstructionSet::kAvx512));
  }
}

}  // namespace
}  // namespace pcednet::nn
