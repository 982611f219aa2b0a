#pragma once

#include <vector>

#include "pcednet/lines/pieces/piece.h"
#include "pcednet/lines/points/ordered_points.h"

namespace pcednet::lines {

/// Puts an arc that touches two segments in place of the piece between their ends, if it passes
/// within `tolerance` (in spacings) of the nodes there and no other edge begins at that piece. A
/// rounded corner of a few spacings has too few nodes for an arc by itself and looks like a
/// chamfer; but where two edges of a chamfer begin, there is a third. Where a wall stands across
/// the edge, its points determine the radius.
void round_corners(std::vector<Piece>& pieces, const OrderedPoints& cloud, double tolerance);

}  // namespace pcednet::lines
