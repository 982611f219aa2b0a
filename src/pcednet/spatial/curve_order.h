#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "pcednet/core/vec3.h"

namespace pcednet::spatial {

/// The indices of the finite points along a space-filling curve (Morton, 21 bits per axis, and as
/// many again within a cell of many points), so that neighbours in the order are neighbours in
/// space at any density.
///
/// The order depends on the set of positions, not on their numbering; coincident points keep the
/// order of their indices. Points that are not finite are left out. Throws Error(kFailure) for more
/// than 2^32 - 2 points.
std::vector<std::uint32_t> curve_order(std::span<const Vec3> positions);

/// Whether points at one place follow each other in their order along the curve.
bool have_copies(std::span<const Vec3> positions, std::span<const std::uint32_t> order);

/// The first point at each place of such an order.
std::vector<std::uint32_t> firsts_of_places(std::span<const Vec3> positions,
                                            std::span<const std::uint32_t> order);

/// The positions numbered `order`, one after the other.
std::vector<Vec3> in_order(std::span<const Vec3> positions, std::span<const std::uint32_t> order);

}  // namespace pcednet::spatial
