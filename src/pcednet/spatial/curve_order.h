#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "pcednet/core/vec3.h"

namespace pcednet::spatial {

/// The indices of the finite points along a space-filling curve (Morton, 21 bits an axis, and as
/// many again within a cell that holds many points), so that neighbours in the order are neighbours
/// in space however unevenly the points lie.
///
/// The order depends on the set of positions alone, not on how they are numbered; points at exactly
/// the same position keep the order of their indices. Points that are not finite are left out. At
/// most 2^32 - 1 points.
std::vector<std::uint32_t> curve_order(std::span<const Vec3> positions);

/// The positions numbered `order`, one after the other.
std::vector<Vec3> in_order(std::span<const Vec3> positions, std::span<const std::uint32_t> order);

}  // namespace pcednet::spatial
