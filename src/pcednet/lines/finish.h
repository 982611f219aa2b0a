#pragma once

#include <vector>

#include "pcednet/lines/curve.h"
#include "pcednet/lines/piece.h"

namespace pcednet::lines {

struct FinishOptions {
  double min_length;   ///< shorter curves are left out
  double tolerance;    ///< in spacings
  double noise;        ///< in spacings
  bool exact = false;  ///< pieces are where planes of many points meet: corners are near their ends
};

/// The class of the edge that the piece is of: kSmoothEdge if the surfaces beside it bend into it
/// and few of its points are sharp-edge.
EdgeClass class_of(const Piece& piece, double noise);

/// The piece between its own ends.
Curve curve_of(const Piece& piece, const FinishOptions& options);

/// Prolongs the pieces to their corners, drops loose short ones, and makes curves of the others.
std::vector<Curve> finish(std::vector<Piece> pieces, const FinishOptions& options);

/// Turns segments that are nearly parallel to a longer one, or orthogonal to one or two, so.
void regularise(std::vector<Piece>& pieces);

}  // namespace pcednet::lines
