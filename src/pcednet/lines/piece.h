#pragma once

#include <array>
#include <cstddef>
#include <optional>
#include <vector>

#include "pcednet/lines/fit.h"
#include "pcednet/lines/split.h"

namespace pcednet::lines {

/// The tolerance of boundaries is no less, in spacings: where points end is a matter of chance.
inline constexpr double kBoundaryTolerance = 0.4;

/// One curve in the making.
struct Piece {
  Fit fit;
  std::vector<ChainNode> nodes;
  std::array<Vec3, 2> ends;  ///< on the fit; unused if closed
  bool closed = false;

  double spacing() const { return nodes[nodes.size() / 2].spacing; }
};

/// The pieces of a chain; those of fewer than `least_nodes` nodes are left out.
std::vector<Piece> pieces_of(const Chain& chain, const std::vector<Run>& runs,
                             std::size_t least_nodes);

/// Length between the ends.
double length_of(const Piece& piece);

/// Joins pieces that lie on one line or circle and continue each other over gaps up to `gap`, and
/// drops those that lie on a longer one. `tolerance` is in spacings.
void join_pieces(std::vector<Piece>& pieces, double gap, double tolerance);

}  // namespace pcednet::lines
