#pragma once

#include <vector>

#include "pcednet/core/progress.h"
#include "pcednet/lines/pieces/piece.h"
#include "pcednet/lines/points/ordered_points.h"
#include "pcednet/lines/points/sampling.h"

namespace pcednet::lines {

/// Replaces the pieces where narrow bores and pins end by circles. Chains cannot follow such an
/// edge, as no plane fits its wall; the points themselves are on a cylinder and a plane. Does
/// nothing in much noise.
void find_bores(std::vector<Piece>& pieces, const OrderedPoints& cloud, const Sampling& sampling,
                const Progress* progress);

}  // namespace pcednet::lines
