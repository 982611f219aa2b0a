#pragma once

#include <vector>

#include "pcednet/lines/piece.h"

namespace pcednet::lines {

/// Which corner each end of each piece is in; kNoCorner: it ends free.
struct Corners {
  static constexpr std::size_t kNoCorner = static_cast<std::size_t>(-1);
  std::vector<Vec3> places;
  std::vector<std::array<std::size_t, 2>> of_ends;
};

/// Prolongs (or shortens) pieces to the places where they meet: ends that are nearer to each other
/// than `reach` and whose curves meet within `tolerance` of one place share a corner there. Lengths
/// are in spacings. Then ends that stop short of the inside of another piece are moved to it.
Corners find_corners(const std::vector<Piece>& pieces, double reach, double tolerance);

/// With the reach and tolerance of points of this noise (in spacings).
Corners find_corners(const std::vector<Piece>& pieces, double noise);

/// The open ends that are in no corner of these.
std::vector<End> free_ends(const std::vector<Piece>& pieces, double noise);

}  // namespace pcednet::lines
