#include <benchmark/benchmark.h>

#include <cmath>
#include <map>
#include <numeric>
#include <vector>

#include "pcednet/core/parallel.h"
#include "pcednet/core/random_vectors.h"
#include "pcednet/spatial/curve_order.h"
#include "pcednet/spatial/kd_tree.h"
#include "pcednet/spatial/neighbour_search.h"

namespace pcednet::spatial {
namespace {

enum Kind { kSphere, kFoliage, kClumps, kFar, kCopies };

Vec3 place(Kind kind, Random& random) {
  const Vec3 p = uniform_vector(random);
  switch (kind) {
    case kSphere:
      return normal_vector(random).normalized();
    case kFoliage:
      return p;
    case kClumps:  // a thousand times as dense
      return random.index(2) == 0 ? Vec3(10 * p)
                                  : Vec3(1e-3 * p + Vec3::Constant(random.index(10)));
    case kFar:
      return random.index(1000) == 0 ? Vec3(1e9 * p) : p;
    case kCopies:
      return random.index(2) == 0 ? Vec3(Vec3::Ones()) : p;
  }
  return p;
}

const std::vector<Vec3>& ordered_points(Kind kind, std::size_t count) {
  static std::map<std::pair<Kind, std::size_t>, std::vector<Vec3>> all;
  std::vector<Vec3>& ordered = all[{kind, count}];
  if (!ordered.empty()) return ordered;
  Random random(1);
  std::vector<Vec3> points;
  for (std::size_t i = 0; i < count; ++i) points.push_back(place(kind, random));
  for (const std::uint32_t i : curve_order(points)) ordered.push_back(points[i]);
  return ordered;
}

void report(benchmark::State& state, std::size_t points) {
  state.counters["s_per_point"] = benchmark::Counter(
      static_cast<double>(points),
      benchmark::Counter::kIsIterationInvariantRate | benchmark::Counter::kInvert);
}

/// The structure and all neighbours, one thread.
void Search(benchmark::State& state, Kind kind, std::size_t count) {
  set_thread_count(1);
  const auto& points = ordered_points(kind, static_cast<std::size_t>(state.range(0)));
  constexpr std::size_t kBlock = 1024;
  std::vector<std::uint32_t> places(points.size());
  std::iota(places.begin(), places.end(), 0u);
  std::vector<Neighbour> found(kBlock * count);
  for (auto _ : state) {
    const NeighbourSearch search(points);
    for (std::size_t i = 0; i < points.size(); i += kBlock) {
      const auto some = std::span(places).subspan(i, std::min(kBlock, points.size() - i));
      search.nearest_others(some, count, found);
    }
    benchmark::DoNotOptimize(found.data());
  }
  report(state, points.size());
}

void Tree(benchmark::State& state, Kind kind, std::size_t count) {
  set_thread_count(1);
  const auto& points = ordered_points(kind, static_cast<std::size_t>(state.range(0)));
  std::vector<Neighbour> found;
  for (auto _ : state) {
    const KdTree tree(points);
    for (const Vec3& p : points) tree.nearest(p, count + 1, found);
    benchmark::DoNotOptimize(found.data());
  }
  report(state, points.size());
}

#define PCEDNET_SIZES Arg(100000)->Arg(1000000)->Unit(benchmark::kMillisecond)
BENCHMARK_CAPTURE(Tree, sphere_12, kSphere, 12)->PCEDNET_SIZES;
BENCHMARK_CAPTURE(Search, sphere_12, kSphere, 12)->PCEDNET_SIZES;
BENCHMARK_CAPTURE(Search, sphere_32, kSphere, 32)->PCEDNET_SIZES;
BENCHMARK_CAPTURE(Search, sphere_300, kSphere, 300)->PCEDNET_SIZES;
BENCHMARK_CAPTURE(Search, foliage_12, kFoliage, 12)->PCEDNET_SIZES;
BENCHMARK_CAPTURE(Search, clumps_12, kClumps, 12)->PCEDNET_SIZES;
BENCHMARK_CAPTURE(Search, far_12, kFar, 12)->PCEDNET_SIZES;
BENCHMARK_CAPTURE(Search, copies_12, kCopies, 12)->PCEDNET_SIZES;

}  // namespace
}  // namespace pcednet::spatial
