#pragma once

#include <vector>

#include "pcednet/lines/piece.h"

namespace pcednet::lines {

/// Joins pieces that continue each other smoothly over gaps up to `gap` into polylines: edges that
/// are neither straight nor round. They may bend by `angle` (radians) where they join. A segment
/// and an arc, or two segments, stay separate if both are long: their kind is certain.
void string_together(std::vector<Piece>& pieces, double gap, double angle);

/// The same for pieces of noisy points with their final extents: two that lie side by side, or
/// overlap, and both end free, are one edge regardless of their kinds. Ends in corners (see
/// free_ends(); `noise` is in spacings) stay.
void string_free_ends(std::vector<Piece>& pieces, double gap, double angle, double noise);

/// The vertices of a polyline that stays within `tolerance` of all `places`, the ends kept.
std::vector<Vec3> simplified(const std::vector<Vec3>& places, double tolerance);

}  // namespace pcednet::lines
