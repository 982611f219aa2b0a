#pragma once

#include <cstddef>
#include <span>

#include "pcednet/core/vec3.h"
#include "pcednet/spatial/neighbour_search.h"

namespace pcednet::normals {

/// How many neighbours a normal needs: 12, or 24 or 48 on noisy clouds.
///
/// Twice the neighbours make the fitted planes relatively thicker where the surface bends and
/// thinner where their thickness is noise. So the count is doubled as long as the median thickness
/// of 2000 points (see PlaneFit) falls, and to begin with only if it is above 0.01. `points` must
/// be distinct and in curve order, and `search` made from them.
std::size_t choose_neighbour_count(std::span<const Vec3> points,
                                   const spatial::NeighbourSearch& search);

}  // namespace pcednet::normals
