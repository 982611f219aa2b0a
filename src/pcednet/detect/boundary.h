#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "pcednet/core/progress.h"
#include "pcednet/detect/classify.h"
#include "pcednet/detect/points/prepare.h"

namespace pcednet::detect {

/// The number of nearest others that decide on a point, and of the rounds that remove isolated
/// points.
inline constexpr std::size_t kBoundaryNeighbours = 24;
inline constexpr int kBoundaryRounds = 3;

/// A point where the sampled surface ends: at eaves, at the rims of holes and fragments.
struct BoundaryPoint {
  std::uint32_t point;
  bool clear;  ///< less noise than half a spacing: nothing else can be there

  friend bool operator==(const BoundaryPoint&, const BoundaryPoint&) = default;
};

/// The boundary points, ascending.
///
/// The 24 nearest others of such a point are on one side of it. They lie in a plane, or a gently
/// bent sheet, with the point; none is within an angle of 105 degrees as seen from it; their centre
/// is off the point by a fifth of their radius; and their normals are those of one sheet, not of
/// the sides of a thin wall. A neighbour on each side along the rim fulfils the same, with the open
/// side in the same direction, and so on: a point at a chance gap has no such neighbours.
///
/// The result is the same for any number of threads, any order of the points and after a flip of
/// all normals. A point without a usable normal is judged by the positions alone. Throws
/// Error(kCancelled) when `progress` asks to cancel.
std::vector<BoundaryPoint> find_boundary(const PreparedCloud& cloud,
                                         const Progress* progress = nullptr);

/// Gives boundary points the class kBoundary, in place of non-edge and unlabelled, and of an edge
/// class where the boundary is clear. Points of an own class keep it.
void mark_boundary(std::span<const BoundaryPoint> boundary, std::span<std::uint8_t> classes);

/// The same for the points of find_boundary(). Their probabilities stay those of the network.
/// `found` must be of the cloud, its classes of a table that has_edges(). Throws Error(kUsage) if
/// it has another number of points, and as find_boundary() does.
void mark_boundary(const PreparedCloud& cloud, Classification& found,
                   const Progress* progress = nullptr);

}  // namespace pcednet::detect
