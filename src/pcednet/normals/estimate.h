#pragma once

#include <optional>
#include <span>
#include <vector>

#include "pcednet/core/progress.h"
#include "pcednet/core/vec3.h"
#include "pcednet/normals/neighbour_count.h"
#include "pcednet/normals/neighbour_graph.h"

namespace pcednet::normals {

/// The unit normal of the surface at every point, its sign arbitrary (see orient.h).
///
/// It is the direction of least variance of the k nearest distinct points y_j, including the point
/// itself: the eigenvector of the smallest eigenvalue of
///
///     C = sum w_j (y_j - m)(y_j - m)^T,   m = sum w_j y_j / sum w_j,   w_j = (1 - (r_j/h)^2)^2
///
/// with r_j the distance to the point and h^2 = 1.05 times the largest r_j^2. The weights keep the
/// plane of a point beside an edge from tilting over it.
///
/// k is 12 unless given, more on noisy clouds: see choose_neighbours(). On clouds of plane faces
/// with many edges, a point on a face gets the normal of the face: see exact_normal().
///
/// (0,0,0) where no plane can be fitted: the position is not finite, there are fewer than three
/// distinct points, or the neighbours are collinear (second eigenvalue below 1e-10 of the largest).
/// The result has the same bytes for any number of threads and any order of the points, and points
/// at the same position get the same normal.
std::vector<Vec3> estimate_normals(std::span<const Vec3> positions,
                                   std::optional<NeighbourChoice> choice = {},
                                   const Progress* progress = nullptr);

/// The same for the points of a graph, as its choice says.
std::vector<Vec3> estimate_normals(const NeighbourGraph& graph, const Progress* progress = nullptr);

}  // namespace pcednet::normals
