#pragma once

#include <cstddef>
#include <cstdint>
#include <span>

#include "pcednet/core/vec3.h"

namespace pcednet::normals {

/// Whether the normals of one connected surface point outwards: from -1 (inwards) to 1, near 0 if
/// that has no meaning, as on an open sheet.
///
/// In each of 48 directions d it takes the mean of n.d over the points within a fiftieth of the
/// surface's extent from the farthest one, and returns the sum of these over the sum of their
/// sizes. `members` are the indices of the surface's points.
double outwardness(std::span<const Vec3> points, std::span<const Vec3> normals,
                   std::span<const std::uint32_t> members);

/// The value of outwardness() below which a surface counts as an open sheet.
inline constexpr double kDecided = 0.3;

}  // namespace pcednet::normals
