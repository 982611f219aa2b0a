#include "pcednet/normals/neighbour_graph.h"

#include <algorithm>
#include <atomic>
#include <numeric>

#include "pcednet/core/parallel_loops.h"
#include "pcednet/core/vector_clones.h"
#include "pcednet/normals/exact_planes.h"
#include "pcednet/spatial/curve_order.h"
#include "pcednet/spatial/neighbour_search.h"

namespace pcednet::normals {
namespace {

constexpr std::size_t kQueriesAtOnce = 1024;

void collect_distinct_points(std::span<const Vec3> positions, NeighbourGraph& graph) {
  const std::vector<std::uint32_t>& order = graph.order;
  std::vector<Vec3> ordered = spatial::in_order(positions, order);
  const auto is_new = [&](std::size_t i) { return i == 0 || ordered[i] != ordered[i - 1]; };
  const auto found = counts_before_blocks(order.size(), kQueriesAtOnce, is_new);
  const bool has_copies = found.back() < order.size();
  if (has_copies) graph.points.resize(found.back());
  graph.point_of.assign(positions.size(), kNoPoint);
  parallel_blocks(order.size(), kQueriesAtOnce, [&](std::size_t begin, std::size_t end) {
    auto count = static_cast<std::uint32_t>(found[begin / kQueriesAtOnce]);
    for (std::size_t i = begin; i < end; ++i) {
      if (is_new(i)) {
        if (has_copies) graph.points[count] = ordered[i];
        ++count;
      }
      graph.point_of[order[i]] = count - 1;
    }
  });
  if (!has_copies) graph.points = std::move(ordered);
}

[[gnu::always_inline]] inline double sq_distance(const double* p, const double* q) {
  const double x = p[0] - q[0], y = p[1] - q[1], z = p[2] - q[2];
  return x * x + y * y + z * z;
}

/// The distance from a point to one of its neighbours, compared with the neighbour's reach.
enum Within : std::uint8_t { kBeyond, kInside, kOnRim };

PCEDNET_VECTOR_CLONES
void compare_with_reach(const Vec3* points, const double* sq_reach, std::size_t i,
                        std::span<const std::uint32_t> row, std::uint8_t* within) {
  const double *const all = points->data(), *const p = all + 3 * i;
  for (std::size_t k = 0; k < row.size(); ++k) {
    const double sq = sq_distance(p, all + 3 * std::size_t{row[k]}), reach = sq_reach[row[k]];
    within[k] = static_cast<std::uint8_t>((sq < reach ? kInside : 0) + (sq == reach ? kOnRim : 0));
  }
}

}  // namespace

NeighbourGraph make_neighbour_graph(std::span<const Vec3> positions,
                                    std::optional<NeighbourChoice> choice, const Progress* progress,
                                    std::span<const std::uint32_t> curve) {
  NeighbourGraph graph;
  graph.order.assign(curve.begin(), curve.end());
  if (curve.empty()) graph.order = spatial::curve_order(positions);
  collect_distinct_points(positions, graph);
  const std::size_t points = graph.points.size();
  if (points == 0) return graph;
  Stage stage(progress, "neighbours", points);
  const spatial::NeighbourSearch search(graph.points);
  graph.choice = choice ? *choice : choose_neighbours(graph.points, search, Counts::kLocal);
  const std::size_t wanted = graph.choice.neighbours;
  graph.choice.neighbours = search.available(wanted);
  graph.degree =
      search.available(graph.choice.exact_planes ? std::max(wanted, kExactNeighbours) : wanted);
  graph.neighbours = UnsetArray<std::uint32_t>(points * graph.degree);
  parallel_blocks(points, kQueriesAtOnce, [&](std::size_t begin, std::size_t end) {
    std::vector<std::uint32_t> some(end - begin);
    std::iota(some.begin(), some.end(), static_cast<std::uint32_t>(begin));
    std::vector<spatial::Neighbour> found(some.size() * graph.degree);
    search.nearest_others(some, graph.degree, found);
    std::transform(found.begin(), found.end(), graph.neighbours.data() + begin * graph.degree,
                   [](const spatial::Neighbour& neighbour) { return neighbour.index; });
    stage.advance(end - begin);
  });
  return graph;
}

NeighbourChoice choose_one_count(std::span<const Vec3> positions) {
  NeighbourGraph graph;
  graph.order = spatial::curve_order(positions);
  collect_distinct_points(positions, graph);
  if (graph.points.empty()) return {};
  return choose_neighbours(graph.points, spatial::NeighbourSearch(graph.points), Counts::kOne);
}

Adjacency make_adjacency(const NeighbourGraph& graph, std::size_t count, const Progress* progress) {
  const std::size_t points = graph.points.size();
  count = std::min(count, graph.degree);
  Adjacency adjacency = {&graph, count, std::vector<std::size_t>(points + 1), {}};
  if (count == 0) return adjacency;
  UnsetArray<double> sq_reach(points);
  parallel_for_each(points, [&](std::size_t i) {
    sq_reach[i] = sq_distance(graph.points[i].data(), graph.points[graph.of(i)[count - 1]].data());
  });
  // Calls work(i, j) for every neighbour j of i that does not have i among its own.
  const auto for_one_sided = [&](const auto& work) {
    parallel_blocks(points, kQueriesAtOnce, [&](std::size_t begin, std::size_t end) {
      throw_if_cancelled(progress);
      std::vector<std::uint8_t> within(count);
      for (std::size_t i = begin; i < end; ++i) {
        const auto row = graph.of(i).first(count);
        compare_with_reach(graph.points.data(), sq_reach.data(), i, row, within.data());
        for (std::size_t k = 0; k < count; ++k) {
          if (within[k] == kInside) continue;
          const auto back = graph.of(row[k]).first(count);
          const bool is_mutual =
              within[k] == kOnRim && std::find(back.begin(), back.end(), i) != back.end();
          if (!is_mutual) work(static_cast<std::uint32_t>(i), row[k]);
        }
      }
    });
  };
  const auto take = [](std::size_t& counter) {
    return std::atomic_ref(counter).fetch_add(1, std::memory_order_relaxed);
  };
  for_one_sided([&](std::uint32_t, std::uint32_t j) { take(adjacency.first[j + 1]); });
  std::partial_sum(adjacency.first.begin(), adjacency.first.end(), adjacency.first.begin());
  adjacency.others = UnsetArray<std::uint32_t>(adjacency.first.back());
  std::vector<std::size_t> next(adjacency.first.begin(), adjacency.first.end() - 1);
  for_one_sided([&](std::uint32_t i, std::uint32_t j) { adjacency.others[take(next[j])] = i; });
  return adjacency;
}

}  // namespace pcednet::normals
