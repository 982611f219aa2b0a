#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <optional>
#include <span>
#include <vector>

#include "pcednet/core/progress.h"
#include "pcednet/core/unset_array.h"
#include "pcednet/core/vec3.h"
#include "pcednet/normals/neighbour_count.h"

namespace pcednet::normals {

inline constexpr std::uint32_t kNoPoint = 0xffffffff;

/// The distinct finite positions of a cloud, each with its nearest neighbours.
///
/// The points are in curve order, so results from this graph, including ties, are the same for any
/// numbering of the cloud, and neighbours are close in memory.
struct NeighbourGraph {
  std::vector<Vec3> points;
  std::vector<std::uint32_t> order;      ///< positions of the cloud; those of one point together
  std::vector<std::uint32_t> point_of;   ///< per position of the cloud, kNoPoint if not finite
  std::size_t degree = 0;                ///< neighbours of each point
  UnsetArray<std::uint32_t> neighbours;  ///< points x degree, nearest first, without the point
  NeighbourChoice choice = {0};          ///< planes are fitted to the nearest of them

  std::span<const std::uint32_t> of(std::size_t point) const {
    return {neighbours.data() + point * degree, degree};
  }
};

/// `choice` is that of choose_neighbours() unless given, with fewer neighbours if there are too few
/// distinct points. `degree` is as much, or kExactNeighbours if these are more and needed. `curve`
/// is spatial::curve_order() of the positions; if empty, it is computed.
NeighbourGraph make_neighbour_graph(std::span<const Vec3> positions,
                                    std::optional<NeighbourChoice> choice = {},
                                    const Progress* progress = nullptr,
                                    std::span<const std::uint32_t> curve = {});

/// The choice of one number of neighbours for all points of a cloud, as other programs make it.
NeighbourChoice choose_one_count(std::span<const Vec3> positions);

/// The undirected graph: every point is linked with its nearest neighbours, and with the other
/// points that have it among theirs.
struct Adjacency {
  const NeighbourGraph* graph = nullptr;
  std::size_t count = 0;             ///< nearest neighbours of each point
  std::vector<std::size_t> first;    ///< points + 1: where the others of each begin
  UnsetArray<std::uint32_t> others;  ///< of point i: first[i] to first[i + 1], in any order

  std::size_t size() const { return first.size() - 1; }
  std::size_t degree(std::size_t point) const { return count + first[point + 1] - first[point]; }
  /// The points linked with one, each once, in two stretches.
  std::array<std::span<const std::uint32_t>, 2> of(std::size_t point) const {
    return {graph->of(point).first(count),
            {others.data() + first[point], first[point + 1] - first[point]}};
  }
};

/// Uses at most the nearest `count` neighbours of each point; `graph` must outlive the result.
/// Throws Error(kCancelled) when `progress` asks to cancel.
Adjacency make_adjacency(const NeighbourGraph& graph, std::size_t count,
                         const Progress* progress = nullptr);

}  // namespace pcednet::normals
