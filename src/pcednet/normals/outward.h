#pragma once

#include <cstddef>
#include <cstdint>
#include <span>

#include "pcednet/core/vec3.h"

namespace pcednet::normals {

/// Whether the normals of one connected surface point outwards: from -1 (inwards) to 1, near 0 if
/// undecided, as on an open sheet.
///
/// For each of 48 directions d, m is the mean of n.d over the points within a fiftieth of the
/// extent of the surface from the extreme one; the result is sum m / sum |m|. `members` are the
/// indices of the points of the surface.
double outwardness(std::span<const Vec3> points, std::span<const Vec3> normals,
                   std::span<const std::uint32_t> members);

/// The magnitude of outwardness() below which a surface counts as an open sheet.
inline constexpr double kDecided = 0.3;

}  // namespace pcednet::normals
