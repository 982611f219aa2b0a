#pragma once

#include <optional>
#include <vector>

#include "pcednet/lines/pieces/piece.h"
#include "pcednet/lines/pieces/placed.h"

namespace pcednet::lines {

/// The circle in which two surfaces of revolution about one axis meet that explain these points
/// beside the arc or circle: planes across the axis, cylinders or cones. Its axis and centre are
/// found with them.
std::optional<Placed> crease_circle(const Piece& piece, const std::vector<Vec3>& points,
                                    const SideLimits& limits);

}  // namespace pcednet::lines
