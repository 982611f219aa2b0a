#pragma once

#include <vector>

#include "pcednet/lines/fit.h"

namespace pcednet::lines {

/// Nodes first to last - 1 of a chain and what they are on; a closed chain's run may go over its
/// end: last is then more than the number of nodes.
struct Run {
  std::size_t first, last;
  Fit fit;
};

/// The chain as the fewest segments and arcs within `tolerance` (in spacings): the runs of least
///
///     sum over runs of (price of its kind + sum over its nodes of min(distance / tolerance, 3)^2)
///
/// by dynamic programming. Runs that no segment and no arc explains are of kind kPolyline. A closed
/// chain of one kArc run is a circle.
std::vector<Run> split(const Chain& chain, double tolerance);

}  // namespace pcednet::lines
