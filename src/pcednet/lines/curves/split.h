#pragma once

#include <vector>

#include "pcednet/lines/curves/fit.h"

namespace pcednet::lines {

/// Nodes first to last - 1 of a chain and their fit; the run of a closed chain may cross its end:
/// last then exceeds the number of nodes.
struct Run {
  std::size_t first, last;
  Fit fit;
};

/// Splits the chain into few segments and arcs within `tolerance` (in spacings): the runs that
/// minimise
///
///     sum over runs of (price of its kind + sum over its nodes of min(distance / tolerance, 3)^2)
///
/// by dynamic programming. Runs that neither a segment nor an arc explains have kind kPolyline. A
/// closed chain of one kArc run is a circle. Throws Error(kCancelled) once the caller cancels.
std::vector<Run> split(const Chain& chain, double tolerance, const Progress* progress = nullptr);

}  // namespace pcednet::lines
