#pragma once

#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

#include "pcednet/lines/points/ordered_points.h"

namespace pcednet::lines {

/// How many neighbours are looked at where the nearest do not tell: where one side of an edge is
/// much denser than the other they are all of the denser, and in noise they are too few.
inline constexpr std::size_t kFarNeighbours = 300;

/// Chooses among neighbours, nearest first, those that are not near one chosen before: as many as
/// NearPoints has room for beside the point itself. `others` are at most kFarNeighbours.
std::vector<spatial::Neighbour> thinned(const OrderedPoints& cloud,
                                        std::span<const spatial::Neighbour> others);

/// Chooses the neighbours that are nearest if lengths along the edge count for a third: as many as
/// NearPoints has room for beside the point itself. The edge runs where the normals do not vary.
/// None if they vary in no direction, or in all.
std::vector<spatial::Neighbour> along_edge(const OrderedPoints& cloud, std::uint32_t point,
                                           std::span<const spatial::Neighbour> others);

}  // namespace pcednet::lines
