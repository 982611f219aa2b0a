#pragma once

#include <optional>
#include <vector>

#include "pcednet/lines/pieces/piece.h"
#include "pcednet/lines/points/sampling.h"

namespace pcednet::lines {

/// The folds and eaves of a roof: a surface seen from above (z is up), nowhere above itself, with
/// nine in ten points on plane faces. None for other clouds, nor where scanners stood at known
/// places: their rows would look like the edges of strips.
std::optional<std::vector<Piece>> find_plane_edges(const OrderedPoints& cloud,
                                                   const Sampling& sampling,
                                                   const Progress* progress);

}  // namespace pcednet::lines
