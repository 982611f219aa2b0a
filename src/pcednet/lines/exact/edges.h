#pragma once

#include <vector>

#include "pcednet/core/progress.h"
#include "pcednet/lines/creases/crease.h"
#include "pcednet/lines/exact/pieces.h"
#include "pcednet/lines/points/ordered_points.h"

namespace pcednet::lines {

/// The segments where exact planes meet, and the arcs and circles where they meet cylinders across
/// them: both surfaces have points along the line, each on one side of it alone, and the points
/// there are perhaps of an edge. For exact points (Sampling). Facets of curved surfaces are left to
/// the chains.
ExactEdges find_exact_edges(const OrderedPoints& cloud, double spacing, const Progress* progress);

/// Makes sharp edges of fillets that labels call so, if there are no probabilities: these labels
/// are not a model's, which takes narrow fillets for sharp.
void keep_labelled(ExactEdges& edges, const OrderedPoints& cloud);

/// Removes the creases along the edges and along those that they replace.
void erase_explained(std::vector<Crease>& creases, const ExactEdges& edges);

}  // namespace pcednet::lines
