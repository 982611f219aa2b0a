#pragma once

#include <vector>

#include "pcednet/lines/pieces/piece.h"

namespace pcednet::lines {

/// Turns pieces, including polylines, that lie about the axis of another circle and go half around
/// it into circles, unless another edge ends in a gap; where edge points of the cloud follow the
/// circle through its gaps, two fifths suffice and other edges do not count. `tolerance` is in
/// spacings.
///
/// Turned parts and bores have several circles on one axis. Where noise breaks one of them into
/// pieces, these are too inaccurate for a circle of their own.
void complete_coaxial(std::vector<Piece>& pieces, const OrderedPoints& cloud, double tolerance);

}  // namespace pcednet::lines
