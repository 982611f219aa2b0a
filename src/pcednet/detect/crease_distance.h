#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "pcednet/core/vec3.h"

namespace pcednet::detect {

/// How far each point is, along its own face, from the nearest line where another face meets that,
/// in `unit`; infinity where no face near it does, and where `wanted` is 0. For points that lie on
/// surfaces to a small part of their spacing. `unit` must be some 1.2 spacings.
///
/// Faces are those of the 24 nearest others: each has the plane that most of its own 16 nearest lie
/// on (normals::face_normal). Another face is turned by 26 degrees or more and explains at least
/// three of the 24 that are not on the point's own face, some of them near the place at which the
/// two planes meet. The nearer of the two best counts. None does where two points lie on the
/// crease itself, as vertices of a mesh do: they are the edge, whatever their spacing.
///
/// Normals play no part, nor do threads or the order of the points. `curve` is the
/// spatial::curve_order() of the positions.
std::vector<float> crease_distances(std::span<const Vec3> positions,
                                    std::span<const std::uint32_t> curve,
                                    std::span<const std::uint8_t> wanted, double unit);

}  // namespace pcednet::detect
