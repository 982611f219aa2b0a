#pragma once

#include <vector>

#include "pcednet/lines/pieces/piece.h"
#include "pcednet/lines/points/ordered_points.h"

namespace pcednet::lines {

/// Joins pieces on one line or circle and with one wedge over gaps wider than those of
/// join_pieces(), if neither meets another piece there and the surface continues between them.
/// `tolerance`, of the joined piece, and `noise` are in spacings.
void bridge_gaps(std::vector<Piece>& pieces, const OrderedPoints& cloud, double tolerance,
                 double noise);

}  // namespace pcednet::lines
