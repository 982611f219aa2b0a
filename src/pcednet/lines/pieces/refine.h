#pragma once

#include <vector>

#include "pcednet/core/progress.h"
#include "pcednet/lines/creases/crease.h"
#include "pcednet/lines/pieces/piece.h"
#include "pcednet/lines/points/ordered_points.h"

namespace pcednet::lines {

/// Places pieces by all adjacent points: segments where the planes of both sides meet, arcs and
/// circles where two cones about one axis meet (cylinders and planes are cones, too), boundaries
/// where the strip of points along them ends. Pieces with sides of other shapes stay unchanged.
void refine(std::vector<Piece>& pieces, const OrderedPoints& cloud, const Sampling& sampling,
            const Progress* progress);

}  // namespace pcednet::lines
