#pragma once

#include <cstdint>
#include <vector>

#include "pcednet/core/progress.h"
#include "pcednet/normals/neighbour_graph.h"

namespace pcednet::normals {

/// Relative thickness (see PlaneFit) from which neighbourhoods are balls of noise.
inline constexpr double kBall = 0.4;

/// How many neighbours each point's plane is fitted to: choice.neighbours, or that or a half or a
/// quarter of it, but no fewer than choice.fewest.
///
/// More neighbours make the planes thinner where there is noise, and thicker where the surface
/// bends. The fewest are doubled as long as most points around have thinner planes with more, or
/// balls of noise before. Points around are those up to twice as far as the most neighbours. They
/// weigh as the inverse squares of their thickness, so that flat places decide for the edges beside
/// them. What is farther does not count: a part of a cloud has the counts of the whole.
std::vector<std::uint32_t> local_counts(const NeighbourGraph& graph,
                                        const Progress* progress = nullptr);

}  // namespace pcednet::normals
