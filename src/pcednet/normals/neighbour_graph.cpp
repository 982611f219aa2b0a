#include "pcednet/normals/neighbour_graph.h"

#include <algorithm>
#include <atomic>
#include <numeric>

#include "pcednet/core/parallel.h"
#include "pcednet/normals/neighbour_count.h"
#include "pcednet/spatial/curve_order.h"
#include "pcednet/spatial/neighbour_search.h"

namespace pcednet::normals {
namespace {

constexpr std::size_t kBlock = 1024;

void collect_distinct_points(std::span<const Vec3> positions, NeighbourGraph& graph) {
  const std::vector<std::uint32_t> order = spatial::curve_order(positions);
  std::vector<Vec3>& points = graph.points;
  points.resize(order.size());
  parallel_blocks(order.size(), kBlock, [&](std::size_t begin, std::size_t end) {
    for (std::size_t i = begin; i < end; ++i) points[i] = positions[order[i]];
  });
  graph.point_of.assign(positions.size(), kNoPoint);
  std::size_t count = 0;
  for (std::size_t i = 0; i < order.size(); ++i) {
    if (count == 0 || points[count - 1] != points[i]) points[count++] = points[i];
    graph.point_of[order[i]] = static_cast<std::uint32_t>(count - 1);
  }
  points.resize(count);
}

double sq_distance(const Vec3& p, const Vec3& q) {
  const Vec3 d = p - q;
  return d.x() * d.x() + d.y() * d.y() + d.z() * d.z();
}

}  // namespace

NeighbourGraph make_neighbour_graph(std::span<const Vec3> positions, std::size_t count,
                                    const Progress* progress) {
  NeighbourGraph graph;
  collect_distinct_points(positions, graph);
  const std::size_t points = graph.points.size();
  if (points == 0) return graph;
  Stage stage(progress, "neighbours", points);
  const spatial::NeighbourSearch search(graph.points);
  graph.degree = search.available(count > 0 ? count : choose_neighbour_count(graph.points, search));
  graph.neighbours.resize(points * graph.degree);
  parallel_blocks(points, kBlock, [&](std::size_t begin, std::size_t end) {
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

Adjacency make_adjacency(const NeighbourGraph& graph, std::size_t count) {
  const std::size_t points = graph.points.size();
  count = std::min(count, graph.degree);
  Adjacency adjacency;
  adjacency.first.assign(points + 1, count);
  adjacency.first[0] = 0;
  if (count == 0) return adjacency;
  const auto by_block = [&](const auto& work) {
    parallel_blocks(points, kBlock, [&](std::size_t begin, std::size_t end) {
      for (std::size_t i = begin; i < end; ++i) work(i, graph.of(i).first(count));
    });
  };
  std::vector<double> sq_reach(points);
  by_block([&](std::size_t i, const auto& row) {
    sq_reach[i] = sq_distance(graph.points[i], graph.points[row.back()]);
  });
  const auto is_mutual = [&](std::size_t i, std::uint32_t j) {
    const double sq = sq_distance(graph.points[i], graph.points[j]);
    if (sq != sq_reach[j]) return sq < sq_reach[j];
    const auto row = graph.of(j).first(count);
    return std::find(row.begin(), row.end(), i) != row.end();
  };

  // A one-sided link is written at both ends; a mutual one is written at each end by that end. The
  // counts of links become the places to write the next link to.
  const auto take = [](std::size_t& counter) {
    return std::atomic_ref(counter).fetch_add(1, std::memory_order_relaxed);
  };
  std::vector<std::uint8_t> mutual(points * count);
  by_block([&](std::size_t i, const auto& row) {
    for (std::size_t k = 0; k < count; ++k) {
      mutual[i * count + k] = is_mutual(i, row[k]);
      if (!mutual[i * count + k]) take(adjacency.first[row[k] + 1]);
    }
  });
  std::partial_sum(adjacency.first.begin(), adjacency.first.end(), adjacency.first.begin());
  adjacency.target.resize(adjacency.first.back());
  std::vector<std::size_t> next(adjacency.first.begin(), adjacency.first.end() - 1);
  by_block([&](std::size_t i, const auto& row) {
    for (std::size_t k = 0; k < count; ++k) {
      adjacency.target[take(next[i])] = row[k];
      if (mutual[i * count + k]) continue;
      adjacency.target[take(next[row[k]])] = static_cast<std::uint32_t>(i);
    }
  });
  return adjacency;
}

}  // namespace pcednet::normals
