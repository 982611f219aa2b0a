#pragma once

#include <cstddef>

#include "pcednet/lines/pieces/piece.h"
#include "pcednet/lines/points/ordered_points.h"

namespace pcednet::lines {

/// Sets what the edge points around a node that no crease made say of it.
void observe(ChainNode& node, const OrderedPoints& cloud);

/// Adds `count` nodes at even distances between the ends of a segment, each as `like` but for its
/// place and what edge points say.
void add_observed_nodes(Piece& segment, std::size_t count, const ChainNode& like,
                        const OrderedPoints& cloud);

}  // namespace pcednet::lines
