#pragma once

#include <vector>

#include "pcednet/core/progress.h"
#include "pcednet/lines/ordered_points.h"
#include "pcednet/lines/piece.h"
#include "pcednet/lines/sampling.h"

namespace pcednet::lines {

/// Puts circles where narrow bores and pins end, in place of the pieces there. Chains cannot
/// follow such an edge, as no plane fits its wall; the points themselves are on a cylinder and a
/// plane. In much noise nothing is done.
void find_bores(std::vector<Piece>& pieces, const OrderedPoints& cloud, const Sampling& sampling,
                const Progress* progress);

}  // namespace pcednet::lines
