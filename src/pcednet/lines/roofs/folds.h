#pragma once

#include <cstdint>
#include <vector>

#include "pcednet/lines/pieces/piece.h"
#include "pcednet/lines/roofs/faces.h"

namespace pcednet::lines {

/// A segment in which the planes of two faces meet.
struct Fold {
  Piece piece;  ///< side a of its nodes is in `face`, side b in `other`
  std::uint32_t face, other;
};

/// The intersections of the planes of faces whose points are adjacent there.
std::vector<Fold> find_roof_folds(const OrderedPoints& cloud, const Faces& faces, double spacing);

}  // namespace pcednet::lines
