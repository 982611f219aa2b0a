#pragma once

#include <vector>

#include "pcednet/lines/pieces/piece.h"

namespace pcednet::lines {

/// Drops the pieces where two faces would meet if there were no chamfer between them: along most of
/// such a piece, on each of its two faces lies an edge from which that face goes on away from it.
/// Exact pieces stay.
void drop_virtual_edges(std::vector<Piece>& pieces);

}  // namespace pcednet::lines
