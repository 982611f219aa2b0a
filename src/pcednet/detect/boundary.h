#pragma once

#include <cstdint>
#include <vector>

#include "pcednet/core/progress.h"
#include "pcednet/detect/classify.h"
#include "pcednet/detect/prepare.h"

namespace pcednet::detect {

/// How many nearest others of a point are looked at, and how often what was found there is looked
/// at again around it.
inline constexpr std::size_t kBoundaryNeighbours = 24;
inline constexpr int kBoundaryRounds = 3;

/// The points where the sampled surface ends, ascending: eaves, the rims of holes and fragments.
///
/// Such a point has its 24 nearest others on one side. They lie in a plane, or a gently bent sheet,
/// with the point; none is in an angle of 105 degrees as seen from it; their centre is off it by a
/// fifth of their radius; and their normals are those of one sheet, not of the sides of a thin
/// wall. A neighbour on each side of it along the rim has the same, with the open side in the same
/// direction, and so on: the point of a chance gap has none.
///
/// The result is the same for any number of threads, any order of the points and after a change of
/// all signs of the normals. A point without a usable normal is judged by the positions alone.
std::vector<std::uint32_t> find_boundary(const PreparedCloud& cloud,
                                         const Progress* progress = nullptr);

/// Gives the points of find_boundary() the class kBoundary, but for those of an own class. Their
/// probabilities stay: they say what the network thought. `found` must be of the cloud, its classes
/// of a table that has_edges().
void mark_boundary(const PreparedCloud& cloud, Classification& found,
                   const Progress* progress = nullptr);

}  // namespace pcednet::detect
