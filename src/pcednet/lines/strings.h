#pragma once

#include <vector>

#include "pcednet/lines/piece.h"

namespace pcednet::lines {

/// Strings pieces that continue each other smoothly over gaps up to `gap` together, as polylines:
/// an edge that is neither straight nor round. They may bend by `angle` (radians) where they join.
/// A segment and an arc, or two segments, that are both long stay apart: they are what they seem.
void string_together(std::vector<Piece>& pieces, double gap, double angle);

/// The same for pieces of noisy points, once they have their final extents: where two are drawn
/// side by side, or overlap, and both end free, they are one edge whatever they seem. Ends in
/// corners (those of free_ends with `noise`, in spacings) stay.
void string_free_ends(std::vector<Piece>& pieces, double gap, double angle, double noise);

/// The vertices of a polyline that stays within `tolerance` of all `places`, the ends kept.
std::vector<Vec3> simplified(const std::vector<Vec3>& places, double tolerance);

}  // namespace pcednet::lines
