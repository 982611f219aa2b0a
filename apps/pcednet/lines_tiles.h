#pragma once

#include <cstdint>
#include <vector>

#include "tiled_cloud.h"

namespace pcednet::app {

/// The points of a cloud that its lines come from; in thick noise, averages of them.
struct PointsNearEdges {
  PointCloud cloud;  ///< positions, normals and scans, and the file's content beside points
  detect::Classification found;
  std::vector<std::uint8_t> partial;  ///< not 0 where points around it may have been left out
};

/// Reads the points near points of an edge class, or near points that may be of one: all points
/// whose cube, of the size of the largest scale, touches a cube with such a point. Throws
/// Error(kFailure) if their lines would take more memory than `limit`.
PointsNearEdges read_near_edges(const TiledCloud& cloud, std::uint64_t limit,
                                const Progress& progress);

/// Throws the same Error without keeping any.
void check_near_edges(const TiledCloud& cloud, std::uint64_t limit, const Progress& progress);

}  // namespace pcednet::app
