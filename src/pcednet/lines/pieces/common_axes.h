#pragma once

#include <vector>

#include "pcednet/lines/pieces/piece.h"

namespace pcednet::lines {

/// Directions that many pieces share: axes of arcs and normals of the faces beside segments. At
/// most six, the most frequent first; each unit and of no particular sign.
std::vector<Vec3> common_axes(const std::vector<Piece>& pieces);

}  // namespace pcednet::lines
