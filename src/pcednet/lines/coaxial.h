#pragma once

#include <vector>

#include "pcednet/lines/piece.h"

namespace pcednet::lines {

/// Makes circles of pieces, polylines among them, that lie about the axis of another circle and go
/// half around it, unless another edge ends in a gap; where edge points of the cloud follow the
/// circle through its gaps, two fifths are enough and no other edge counts. `tolerance` is in
/// spacings.
///
/// Turned parts and bores have several circles on one axis. Where noise breaks one of them into
/// pieces, these bend and stand too badly for a circle of their own.
void complete_coaxial(std::vector<Piece>& pieces, const OrderedPoints& cloud, double tolerance);

}  // namespace pcednet::lines
