#pragma once

#include <vector>

#include "pcednet/core/progress.h"
#include "pcednet/lines/crease.h"
#include "pcednet/lines/ordered_points.h"
#include "pcednet/lines/piece.h"

namespace pcednet::lines {

/// The segments where exact planes meet: both have points along the line, each on one side of it
/// alone, and the points there are perhaps of an edge. For exact points (Sampling).
/// Facets of curved surfaces are left to the chains.
std::vector<Piece> find_exact_folds(const OrderedPoints& cloud, double spacing,
                                    const Progress* progress);

/// Removes the creases along such segments.
void erase_explained(std::vector<Crease>& creases, const std::vector<Piece>& folds);

}  // namespace pcednet::lines
