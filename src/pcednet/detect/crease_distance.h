#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "pcednet/core/vec3.h"

namespace pcednet::detect {

/// The distance of each point, along its own face and in units of `unit`, to the nearest line where
/// another face meets that face; infinity where no face near it does, and where `wanted` is 0. For
/// points that lie on surfaces to a small fraction of their spacing. `unit` must be about 1.2
/// spacings.
///
/// Faces are found among the 24 nearest others: each has the plane on which most of its own 16
/// nearest lie (normals::face_normal). Another face is turned by 26 degrees or more and explains at
/// least three of the 24 that are not on the point's own face, some of them near the line where the
/// two planes meet. The nearer of the two best counts. Where two points lie on the crease itself,
/// as vertices of a mesh do, no other face counts: these points are the edge, whatever their
/// spacing.
///
/// The result depends neither on normals, threads nor the order of the points. `curve` is the
/// spatial::curve_order() of the positions.
std::vector<float> crease_distances(std::span<const Vec3> positions,
                                    std::span<const std::uint32_t> curve,
                                    std::span<const std::uint8_t> wanted, double unit);

}  // namespace pcednet::detect
