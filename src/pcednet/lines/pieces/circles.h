#pragma once

#include <vector>

#include "pcednet/lines/pieces/piece.h"

namespace pcednet::lines {

/// Joins arcs of one circle across gaps of any size, and closes those that span more than half a
/// circle unless another long piece ends where a gap begins; those that span more than a third are
/// closed regardless of other pieces where edge points of the cloud follow the circle through its
/// gaps. Before that, circles of up to five spacings replace the pieces around them that lie on
/// none alone, unless these are the sides of a polygon.
void complete_circles(std::vector<Piece>& pieces, const OrderedPoints& cloud, double tolerance);

}  // namespace pcednet::lines
