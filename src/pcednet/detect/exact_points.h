#pragma once

#include <cstdint>
#include <span>

#include "pcednet/core/vec3.h"

namespace pcednet::detect {

/// Whether points lie on the plane faces of a model more exactly than any measured point: for 2,000
/// points, evenly spread along the curve, planes are fitted to those with 12 others near them on
/// it, and one plane in ten has a thickness (see normals::PlaneFit) below 1e-6. Parts sampled
/// without noise have 1e-12, the cleanest scans 1e-4. Points along a line do not count
/// (normals::fill_a_plane()): those of a scan line are all on the plane that the scanner's beam
/// sweeps.
///
/// `curve` is the spatial::curve_order() of the positions.
bool is_exact(std::span<const Vec3> positions, std::span<const std::uint32_t> curve);

}  // namespace pcednet::detect
