#pragma once

#include <vector>

#include "pcednet/lines/piece.h"

namespace pcednet::lines {

/// Joins arcs of one circle whatever the gaps between them, and closes those of more than half a
/// circle unless another long piece ends where a gap begins; where edge points of the cloud follow
/// the circle through its gaps, those of more than a third whatever ends there. Before that,
/// circles of up to five spacings take the place of the pieces around them that lie on none alone,
/// unless they are the sides of a polygon.
void complete_circles(std::vector<Piece>& pieces, const OrderedPoints& cloud, double tolerance);

}  // namespace pcednet::lines
