#pragma once

#include <cstdint>
#include <span>

#include "pcednet/core/vec3.h"

namespace pcednet {

/// The smallest of the steps of x, y and z: the largest number of which the differences of these
/// points in one coordinate are multiples. 0 if it would be below 1e-8 of their extent, or if all
/// points coincide.
double coordinate_step(std::span<const Vec3> positions, std::span<const std::uint32_t> points);

}  // namespace pcednet
