#pragma once

#include <vector>

#include "pcednet/lines/pieces/piece.h"

namespace pcednet::lines {

/// The corner of each end of each piece; kNoCorner: a free end.
struct Corners {
  static constexpr std::size_t kNoCorner = static_cast<std::size_t>(-1);
  std::vector<Vec3> places;
  std::vector<std::array<std::size_t, 2>> of_ends;
};

/// Extends (or shortens) pieces to their meeting points: ends nearer to each other than `reach`,
/// whose curves meet within `tolerance` of one place, share a corner there. Lengths are in
/// spacings. Then ends that stop short of the interior of another piece are moved onto it.
Corners find_corners(const std::vector<Piece>& pieces, double reach, double tolerance);

/// With the reach and tolerance for points with this noise (in spacings).
Corners find_corners(const std::vector<Piece>& pieces, double noise);

/// The open ends outside all of these corners.
std::vector<End> free_ends(const std::vector<Piece>& pieces, double noise);

}  // namespace pcednet::lines
