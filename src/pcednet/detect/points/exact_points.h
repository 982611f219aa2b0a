#pragma once

#include <cstdint>
#include <span>

#include "pcednet/core/vec3.h"

namespace pcednet::detect {

/// Of a plane (see normals::PlaneFit) that points lie on more exactly than any measured point.
inline constexpr double kExactThickness = 1e-6;

/// Whether points lie exactly on the plane faces of a model: for 2,000 points, planes are fitted
/// to those with 12 others near them, see near_on_curve(), and one plane in ten has a thickness
/// below that. Parts sampled without noise have 1e-12, the cleanest scans 1e-4. Points along a line
/// do not count (normals::fill_a_plane()): those of a scan line are all on the plane that the
/// scanner's beam sweeps. Nor do points most of which are in rows with two near them: those of a
/// grid of volumes (a fused scan, a remeshed part) are exact on its planes, but blurred at edges.
///
/// `curve` is the spatial::curve_order() of the positions.
bool is_exact(std::span<const Vec3> positions, std::span<const std::uint32_t> curve);

}  // namespace pcednet::detect
