#pragma once

#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

#include "pcednet/core/progress.h"
#include "pcednet/core/unset_array.h"
#include "pcednet/core/vec3.h"

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
  std::size_t fitted = 0;                ///< the nearest of them, which planes are fitted to
  bool has_exact_planes = false;         ///< see NeighbourChoice

  std::span<const std::uint32_t> of(std::size_t point) const {
    return {neighbours.data() + point * degree, degree};
  }
};

/// `degree` becomes `count`, or less if there are too few distinct points; for `count` 0,
/// choose_neighbours() chooses it. `curve` is spatial::curve_order() of the positions; if
/// empty, it is computed. `exact_planes` becomes has_exact_planes where `count` is given. At most
/// 2^32 - 1 positions.
NeighbourGraph make_neighbour_graph(std::span<const Vec3> positions, std::size_t count,
                                    const Progress* progress,
                                    std::span<const std::uint32_t> curve = {},
                                    bool exact_planes = false);

/// The undirected graph: for every point its neighbours and the points that have it as a neighbour,
/// each once.
struct Adjacency {
  std::vector<std::size_t> first;    ///< points + 1
  UnsetArray<std::uint32_t> target;  ///< of point i: first[i] to first[i + 1], in any order

  std::size_t size() const { return first.size() - 1; }
  std::span<const std::uint32_t> of(std::size_t point) const {
    return {target.data() + first[point], first[point + 1] - first[point]};
  }
};

/// Uses at most the nearest `count` neighbours of each point.
Adjacency make_adjacency(const NeighbourGraph& graph, std::size_t count);

}  // namespace pcednet::normals
