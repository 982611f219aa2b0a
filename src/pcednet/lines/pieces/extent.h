#pragma once

#include <vector>

#include "pcednet/lines/pieces/piece.h"
#include "pcednet/lines/points/ordered_points.h"

namespace pcednet::lines {

/// Extends the ends of segments and arcs that meet no other piece: as far as the cloud has points
/// on both surfaces beside them, but not beside another piece of the same direction. `noise` is in
/// spacings.
void extend_free_ends(std::vector<Piece>& pieces, const OrderedPoints& cloud, double noise);

}  // namespace pcednet::lines
