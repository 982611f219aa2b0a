#pragma once

#include <cstddef>
#include <cstdint>
#include <span>

#include "pcednet/core/vec3.h"

namespace pcednet::detect {

/// The share of flat places whose normals lie across the plane of their points, of those of
/// near_on_curve() with so many near. 0 if few places are flat: then nothing is known. Signs and
/// unusable normals do not matter.
double share_of_misfits(std::span<const Vec3> positions, std::span<const Vec3> normals,
                        std::span<const std::uint32_t> curve, std::size_t count);

}  // namespace pcednet::detect
