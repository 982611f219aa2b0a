#include "pcednet/normals/neighbour_graph.h"

#include <algorithm>
#include <numeric>

#include "pcednet/core/parallel.h"
#include "pcednet/normals/neighbour_count.h"
#include "pcednet/spatial/curve_order.h"
#include "pcednet/spatial/neighbour_search.h"

namespace pcednet::normals {
namespace {

constexpr std::size_t kBlock = 1024;

void collect_distinct_points(std::span<const Vec3> positions, NeighbourGraph& graph) {
  graph.point_of.assign(positions.size(), kNoPoint);
  for (const std::uint32_t i : spatial::curve_order(positions)) {
    if (graph.points.empty() || graph.points.back() != positions[i]) {
      graph.points.push_back(positions[i]);
    }
    graph.point_of[i] = static_cast<std::uint32_t>(graph.points.size() - 1);
  }
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
  const auto nearest = [&](std::size_t i) { return graph.of(i).first(count); };
  const auto is_mutual = [&](std::size_t i, std::uint32_t j) {
    const auto row = nearest(j);
    return std::find(row.begin(), row.end(), i) != row.end();
  };

  // A one-sided link is written at both ends; a mutual one is written at each end by that end.
  std::vector<std::uint8_t> mutual(points * count);
  parallel_blocks(points, kBlock, [&](std::size_t begin, std::size_t end) {
    for (std::size_t i = begin; i < end; ++i) {
      for (std::size_t k = 0; k < count; ++k) {
        mutual[i * count + k] = is_mutual(i, nearest(i)[k]);
      }
    }
  });
  Adjacency adjacency;
  adjacency.first.assign(points + 1, 0);
  for (std::size_t i = 0; i < points; ++i) {
    adjacency.first[i + 1] += count;
    for (std::size_t k = 0; k < count; ++k) {
      if (!mutual[i * count + k]) ++adjacency.first[nearest(i)[k] + 1];
    }
  }
  for (std::size_t i = 0; i < points; ++i) adjacency.first[i + 1] += adjacency.first[i];
  adjacency.target.resize(adjacency.first.back());
  std::vector<std::size_t> next(adjacency.first.begin(), adjacency.first.end() - 1);
  for (std::size_t i = 0; i < points; ++i) {
    for (std::size_t k = 0; k < count; ++k) {
      const std::uint32_t j = nearest(i)[k];
      adjacency.target[next[i]++] = j;
      if (!mutual[i * count + k]) adjacency.target[next[j]++] = static_cast<std::uint32_t>(i);
    }
  }
  parallel_blocks(points, kBlock, [&](std::size_t begin, std::size_t end) {
    for (std::size_t i = begin; i < end; ++i) {
      std::sort(adjacency.target.begin() + static_cast<std::ptrdiff_t>(adjacency.first[i]),
                adjacency.target.begin() + static_cast<std::ptrdiff_t>(adjacency.first[i + 1]));
    }
  });
  return adjacency;
}

}  // namespace pcednet::normals
