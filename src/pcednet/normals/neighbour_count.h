#pragma once

#include <cstddef>
#include <span>

#include "pcednet/core/vec3.h"
#include "pcednet/spatial/neighbour_search.h"

namespace pcednet::normals {

/// The number of neighbours to estimate normals from: 12, or 24 or 48 on noisy clouds.
///
/// Twice the neighbours increase the relative thickness of the fitted planes where the surface
/// bends and reduce it where it is noise. The count is therefore doubled as long as the median
/// thickness of 2000 points (see PlaneFit) falls, the first time only if it is above 0.01. `points`
/// must be distinct and in curve order, and `search` made from them.
std::size_t choose_neighbour_count(std::span<const Vec3> points,
                                   const spatial::NeighbourSearch& search);

}  // namespace pcednet::normals
