#include <benchmark/benchmark.h>

#include <ctime>
#include <map>
#include <string>
#include <utility>
#include <vector>

#include "clouds.h"

#include "pcednet/core/parallel.h"
#include "pcednet/core/random.h"
#include "pcednet/gls/engine/fast_scale_space.h"
#include "pcednet/gls/engine/target_groups.h"
#include "pcednet/gls/exact_scale_space.h"

namespace pcednet::gls {
namespace {

OrientedPoints points_of(const bench::Cloud& cloud) {
  return {cloud.positions, cloud.normals};
}

const bench::Cloud& cloud_of(const std::string& name, std::size_t count) {
  static std::map<std::pair<std::string, std::size_t>, bench::Cloud> clouds;
  const auto [at, is_new] = clouds.try_emplace({name, count});
  if (is_new) at->second = bench::make_cloud(name, count);
  return at->second;
}

/// Ranges of the order, spread over the cloud: 1/`part` of it.
template <typename Space>
std::vector<std::uint32_t> sample(const Space& space, std::size_t stretch, std::size_t part) {
  std::vector<std::uint32_t> targets;
  for (std::size_t i = 0; i < space.order().size(); i += stretch * part) {
    const auto some = space.order().subspan(i, std::min(stretch, space.order().size() - i));
    targets.insert(targets.end(), some.begin(), some.end());
  }
  return targets;
}

/// Where a description goes: reused, as by the program.
struct Rows {
  std::vector<float> features;
  std::vector<FitStatus> status;
};

template <typename Space>
void describe(const Space& space, const std::vector<std::uint32_t>& targets, Rows& rows) {
  const std::size_t cells = targets.size() * space.scales().size();
  rows.features.resize(cells * static_cast<std::size_t>(column_count(space.options())));
  rows.status.resize(cells);
  space.describe(targets, std::span<float>(rows.features), rows.status);
  benchmark::DoNotOptimize(rows.features.data());
}

double cpu_seconds() {
  return static_cast<double>(std::clock()) / CLOCKS_PER_SEC;
}

/// Seconds of CPU per point of the exact engine, on one thread.
double exact_cost(const std::string& name, std::size_t count) {
  static std::map<std::pair<std::string, std::size_t>, double> costs;
  const auto [at, is_new] = costs.try_emplace({name, count});
  if (!is_new) return at->second;
  const ExactScaleSpace space(points_of(cloud_of(name, count)), {});
  const auto targets = sample(space, 64, std::max<std::size_t>(1, count / 1024));
  Rows rows;
  const double start = cpu_seconds();
  describe(space, targets, rows);
  return at->second = (cpu_seconds() - start) / static_cast<double>(targets.size());
}

/// Everything before the first point is described: order, s_min, pyramid.
void build(benchmark::State& state, const std::string& name) {
  set_thread_count(1);
  const auto count = static_cast<std::size_t>(state.range(0));
  const bench::Cloud& cloud = cloud_of(name, count);
  for (auto _ : state) benchmark::DoNotOptimize(FastScaleSpace(points_of(cloud), {}));
  state.counters["s_per_point"] =
      benchmark::Counter(static_cast<double>(count), benchmark::Counter::kIsIterationInvariantRate |
                                                         benchmark::Counter::kInvert);
}

void describe_cloud(benchmark::State& state, const std::string& name,
                    const ScaleSpaceOptions& options) {
  set_thread_count(1);
  const auto count = static_cast<std::size_t>(state.range(0));
  const FastScaleSpace space(points_of(cloud_of(name, count)), options);
  const auto targets = sample(space, kPointsTogether, std::max<std::size_t>(1, count / 100000));
  Rows rows;
  describe(space, targets, rows);
  const double start = cpu_seconds();
  for (auto _ : state) describe(space, targets, rows);
  const double spent = cpu_seconds() - start;
  const double points = static_cast<double>(targets.size());
  state.counters["s_per_point"] = benchmark::Counter(
      points, benchmark::Counter::kIsIterationInvariantRate | benchmark::Counter::kInvert);
  if (options.reconstruction != Reconstruction::kSphere || options.side_gate) return;
  const double each = spent / (points * static_cast<double>(state.iterations()));
  state.counters["exact_over_fast"] = exact_cost(name, count) / each;
}

/// Only the innermost sums, for each vector code; arithmetic as in lane_sums.h.
void Sums(benchmark::State& state) {
  const auto kernels = all_lane_kernels();
  const auto which = static_cast<std::size_t>(state.range(0));
  if (which >= kernels.size()) return state.SkipWithError("not on this processor");
  constexpr std::size_t kSources = 200;
  Random random(1);
  std::vector<Source> sources(kSources);
  std::vector<std::uint32_t> indices(kSources);
  const auto number = [&] { return static_cast<float>(random.uniform(-0.5, 0.5)); };
  for (std::size_t i = 0; i < kSources; ++i) {
    sources[i] = {number(), number(), number(), number(), number(),
                  number(), 1.0f,     0.01f,    number()};
    indices[i] = static_cast<std::uint32_t>((i * 7) % kSources);
  }
  LaneTargets targets;
  for (std::size_t lane = 0; lane < kLanes; ++lane) {
    targets.x[lane] = number(), targets.y[lane] = number(), targets.z[lane] = number();
  }
  LaneSums sums;
  for (auto _ : state) {
    kernels[which].sum({.all = sources.data(),
                        .open = indices.data(),
                        .rest = nullptr,
                        .open_count = kSources,
                        .rest_count = 0,
                        .points = false},
                       targets, nullptr, 0, &sums);
    benchmark::DoNotOptimize(sums);
  }
  constexpr double kFusedPerInteraction = 43.0;  // multiplications, with or without an addition
  const double interactions = kSources * kLanes;
  state.SetLabel(kernels[which].name);
  state.counters["s_per_interaction"] = benchmark::Counter(
      interactions, benchmark::Counter::kIsIterationInvariantRate | benchmark::Counter::kInvert);
  state.counters["fused_per_s"] = benchmark::Counter(interactions * kFusedPerInteraction,
                                                     benchmark::Counter::kIsIterationInvariantRate);
}

BENCHMARK(Sums)->Arg(0)->Arg(1)->Arg(2)->Unit(benchmark::kMicrosecond);

/// The gates of the model cad.
const ScaleSpaceOptions kTwoGates = {.side_gate = 0.4, .second_gate = -0.3};
const ScaleSpaceOptions kProjected = [] {
  ScaleSpaceOptions options;
  options.reconstruction = Reconstruction::kSphereMls;
  return options;
}();

/// Every kind of cloud: Build/NAME/POINTS, Describe/NAME/POINTS and DescribeTwoGates/NAME/POINTS.
const bool registered = [] {
  for (const bench::CloudKind& kind : bench::cloud_kinds()) {
    const std::string name = kind.name;
    for (const std::int64_t count : {100'000, 1'000'000}) {
      benchmark::RegisterBenchmark(("Build/" + name).c_str(), build, name)
          ->Arg(count)
          ->Unit(benchmark::kMillisecond);
      for (const auto& [what, options] : {std::pair("Describe/", ScaleSpaceOptions{}),
                                          std::pair("DescribeTwoGates/", kTwoGates)}) {
        benchmark::RegisterBenchmark((what + name).c_str(), describe_cloud, name, options)
            ->Arg(count)
            ->Unit(benchmark::kMillisecond);
      }
    }
  }
  benchmark::RegisterBenchmark("DescribeProjected/scene", describe_cloud, "scene", kProjected)
      ->Arg(100'000)
      ->Unit(benchmark::kMillisecond);
  return true;
}();

}  // namespace
}  // namespace pcednet::gls
