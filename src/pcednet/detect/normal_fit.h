#pragma once

#include <cstdint>
#include <span>

#include "pcednet/core/vec3.h"

namespace pcednet::detect {

/// The share of flat places whose normals lie across the plane of their points, of those of
/// near_on_curve(). 0 if few places are flat: then nothing is known. Signs and unusable normals do
/// not matter. Planes of 12 points and of 48 are tried, and the lesser share counts: the 12 nearest
/// may all be of one scan line, on the plane that the beam swept.
double share_of_misfits(std::span<const Vec3> positions, std::span<const Vec3> normals,
                        std::span<const std::uint32_t> curve);

}  // namespace pcednet::detect
