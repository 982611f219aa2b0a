#pragma once

#include <vector>

#include "pcednet/lines/ordered_points.h"
#include "pcednet/lines/piece.h"

namespace pcednet::lines {

struct BridgeOptions {
  double tolerance;  ///< of the joined piece, in spacings
  double noise;      ///< in spacings
};

/// Joins pieces on one line or circle and with one wedge over gaps wider than those of
/// join_pieces(), if neither meets another piece there and the surface continues between them.
void bridge_gaps(std::vector<Piece>& pieces, const OrderedPoints& cloud,
                 const BridgeOptions& options);

}  // namespace pcednet::lines
