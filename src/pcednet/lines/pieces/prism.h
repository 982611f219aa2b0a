#pragma once

#include <vector>

#include "pcednet/lines/pieces/piece.h"
#include "pcednet/lines/pieces/rim.h"
#include "pcednet/lines/points/ordered_points.h"

namespace pcednet::lines {

/// The corners of the polygon in which a narrow prism ends, in their order about the axis: where
/// segments along the axis of `rim` meet its plane, those missing between others at even angles
/// among them. Empty unless they are all around the axis and explain the points of the wall better
/// than the circle does. `ends` are of segments; lengths are in `spacing`.
std::vector<Vec3> corners_of_prism(const Rim& rim, const std::vector<Piece>& pieces,
                                   const EndIndex& ends, const OrderedPoints& cloud,
                                   double spacing);

}  // namespace pcednet::lines
