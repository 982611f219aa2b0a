#include <benchmark/benchmark.h>

#include <cmath>
#include <numeric>
#include <vector>

#include "pcednet/core/parallel.h"
#include "pcednet/core/random.h"
#include "pcednet/nn/gradient.h"
#include "pcednet/nn/network.h"
#include "pcednet/nn/plan.h"
#include "pcednet/nn/predict.h"
#include "pcednet/nn/standardise.h"
#include "pcednet/nn/train.h"

namespace pcednet::nn {
namespace {

std::vector<float> random_numbers(std::size_t count) {
  Random random(1);
  std::vector<float> numbers(count);
  for (float& x : numbers) x = static_cast<float>(random.normal());
  return numbers;
}

Model make_model(NetworkKind kind, Symmetry symmetry = Symmetry::kNone) {
  Architecture architecture;
  architecture.kind = kind;
  Model model;
  model.network = make_network(architecture, 1);
  model.standardisation = no_standardisation(architecture.inputs());
  model.sign_rule = {symmetry, {1, 1, 1, 1, 1, 0}, 1};
  return model;
}

/// PCEDNet in a plain implementation: a point at a time, a number at a time.
void predict_plainly(const Model& model, const std::vector<float>& samples,
                     std::vector<float>& probabilities) {
  const Plan plan = make_plan(model.network.architecture);
  const float* parameters = model.network.parameters.data();
  std::vector<float> row(static_cast<std::size_t>(plan.rows));
  for (std::size_t i = 0; i < probabilities.size() / 3; ++i) {
    std::copy_n(samples.data() + 96 * i, 96, row.data());
    for (const Layer& layer : plan.layers) {
      for (const AffineMap& map : layer.maps) {
        for (int o = 0; o < map.outputs; ++o) {
          float sum = parameters[map.bias + static_cast<std::size_t>(o)];
          for (int k = 0; k < map.length; ++k) {
            sum += parameters[map.weight + static_cast<std::size_t>(o * map.length + k)] *
                   row[static_cast<std::size_t>(map.in_row + k)];
          }
          row[static_cast<std::size_t>(map.out_row + o)] =
              layer.activation == Activation::kSigmoid ? 1.0f / (1.0f + std::exp(-sum)) : sum;
        }
      }
    }
    float total = 0.0f;
    for (std::size_t c = 0; c < 3; ++c) {
      total += probabilities[3 * i + c] = std::exp(row[row.size() - 3 + c]);
    }
    for (std::size_t c = 0; c < 3; ++c) probabilities[3 * i + c] /= total;
  }
}

void count_points(benchmark::State& state, std::size_t points) {
  state.SetItemsProcessed(static_cast<std::int64_t>(points) * state.iterations());
}

void BM_PredictPlainly(benchmark::State& state) {
  const Model model = make_model(NetworkKind::kPcednet);
  const std::vector<float> samples = random_numbers(96 * 10000);
  std::vector<float> probabilities(3 * 10000);
  for (auto _ : state) predict_plainly(model, samples, probabilities);
  count_points(state, 10000);
}
BENCHMARK(BM_PredictPlainly)->UseRealTime();

/// Arguments: network, symmetry, instruction set, threads (0: all).
void BM_Predict(benchmark::State& state) {
  const auto instructions = static_cast<InstructionSet>(state.range(2));
  if (instructions > instruction_set()) return state.SkipWithError("not on this processor");
  const Model model =
      make_model(static_cast<NetworkKind>(state.range(0)), static_cast<Symmetry>(state.range(1)));
  constexpr std::size_t kPoints = 200000;
  const std::vector<float> samples = random_numbers(96 * kPoints);
  std::vector<float> probabilities(3 * kPoints);
  set_thread_count(static_cast<int>(state.range(3)));
  for (auto _ : state) predict_into(model, samples, probabilities, nullptr, instructions);
  set_thread_count(0);
  count_points(state, kPoints);
}
BENCHMARK(BM_Predict)
    ->ArgNames({"network", "symmetry", "vectors", "threads"})
    ->Args({0, 0, 0, 1})
    ->Args({0, 0, 1, 1})
    ->Args({0, 0, 2, 1})
    ->Args({0, 0, 2, 0})
    ->Args({0, 1, 2, 1})
    ->Args({0, 2, 2, 1})
    ->Args({1, 0, 2, 1})
    ->Args({2, 0, 2, 1})
    ->UseRealTime();

/// Arguments: network, symmetry, instruction set, threads (0: all). One step over a batch of 512.
void BM_Gradient(benchmark::State& state) {
  const auto instructions = static_cast<InstructionSet>(state.range(2));
  if (instructions > instruction_set()) return state.SkipWithError("not on this processor");
  const Model model =
      make_model(static_cast<NetworkKind>(state.range(0)), static_cast<Symmetry>(state.range(1)));
  constexpr std::size_t kPoints = 100000;
  constexpr std::size_t kBatch = 512;
  const std::vector<float> samples = random_numbers(96 * kPoints);
  std::vector<std::uint8_t> labels(kPoints);
  for (std::size_t i = 0; i < kPoints; ++i) labels[i] = static_cast<std::uint8_t>(i % 3);
  std::vector<std::uint32_t> order(kPoints);
  std::iota(order.begin(), order.end(), 0u);
  Random random(1);
  random.shuffle(std::span(order));
  GradientMachine machine(model, instructions);
  std::vector<float> gradient(model.network.parameters.size());
  set_thread_count(static_cast<int>(state.range(3)));
  std::size_t at = 0;
  for (auto _ : state) {
    machine.run({samples, labels}, std::span(order).subspan(at, kBatch), gradient);
    at = at + 2 * kBatch < kPoints ? at + kBatch : 0;
  }
  set_thread_count(0);
  count_points(state, kBatch);
}
BENCHMARK(BM_Gradient)
    ->ArgNames({"network", "symmetry", "vectors", "threads"})
    ->Args({0, 0, 0, 1})
    ->Args({0, 0, 1, 1})
    ->Args({0, 0, 2, 1})
    ->Args({0, 0, 2, 0})
    ->Args({0, 1, 2, 1})
    ->Args({1, 0, 2, 1})
    ->Args({2, 0, 2, 1})
    ->UseRealTime();

/// A whole training on as many labelled points as a user paints.
void BM_TrainFewPoints(benchmark::State& state) {
  const auto points = static_cast<std::size_t>(state.range(0));
  const std::vector<float> samples = random_numbers(96 * points);
  std::vector<std::uint8_t> labels(points);
  for (std::size_t i = 0; i < points; ++i) labels[i] = static_cast<std::uint8_t>(i % 3);
  for (auto _ : state) benchmark::DoNotOptimize(train({}, {samples, labels}));
}
BENCHMARK(BM_TrainFewPoints)
    ->Arg(50)
    ->Arg(500)
    ->Arg(2000)
    ->UseRealTime()
    ->Unit(benchmark::kMillisecond);

}  // namespace
}  // namespace pcednet::nn
