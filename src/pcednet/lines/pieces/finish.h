#pragma once

#include <vector>

#include "pcednet/lines/curves/curve.h"
#include "pcednet/lines/pieces/piece.h"

namespace pcednet::lines {

struct FinishOptions {
  double tolerance;    ///< in spacings
  double noise;        ///< in spacings
  bool exact = false;  ///< pieces are intersections of planes through many points: corners are near
                       ///< their ends
};

/// The class of the piece's edge: kSmoothEdge if it is a fillet, or if the adjacent surfaces bend
/// into it and few of its points are sharp-edge.
EdgeClass class_of(const Piece& piece, double noise);

/// The piece between its own ends.
Curve curve_of(const Piece& piece, const FinishOptions& options);

/// Extends the pieces to their corners, drops loose short ones, and turns the others into curves.
std::vector<Curve> finish(std::vector<Piece> pieces, const FinishOptions& options);

}  // namespace pcednet::lines
