#pragma once

#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

#include "pcednet/lines/ordered_points.h"

namespace pcednet::lines {

/// Where one side of an edge is much denser than the other, the nearest points are all of the
/// denser; in noise there are too few of them. So many are looked at then.
inline constexpr std::size_t kFarNeighbours = 300;

/// Of these, nearest first, at most kFarNeighbours, those that are not near one chosen before: as
/// many as NearPoints has room for beside the point itself.
std::vector<spatial::Neighbour> thinned(const OrderedPoints& cloud,
                                        std::span<const spatial::Neighbour> others);

/// Of these, those that are nearest if lengths along the edge count for a third: as many as
/// NearPoints has room for beside the point itself. The edge runs where the normals do not vary.
/// None if they vary in no direction, or in all.
std::vector<spatial::Neighbour> along_edge(const OrderedPoints& cloud, std::uint32_t point,
                                           std::span<const spatial::Neighbour> others);

}  // namespace pcednet::lines
