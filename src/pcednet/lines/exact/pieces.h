#pragma once

#include <utility>
#include <vector>

#include "pcednet/lines/pieces/piece.h"

namespace pcednet::lines {

/// Exact edges, and those that they replace.
struct ExactEdges {
  std::vector<Piece> pieces;
  std::vector<Piece> rounded;  ///< fillets narrower than a few spacings
  std::vector<Piece> cut_off;  ///< where surfaces would meet without a chamfer: no edges
};

inline void append(ExactEdges& edges, ExactEdges more) {
  append(edges.pieces, std::move(more.pieces));
  append(edges.rounded, std::move(more.rounded));
  append(edges.cut_off, std::move(more.cut_off));
}

}  // namespace pcednet::lines
