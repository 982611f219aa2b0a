#include "pcednet/normals/prepare.h"

#include <algorithm>

namespace pcednet::normals {

PreparedNormals estimate_oriented_normals(std::span<const Vec3> positions,
                                          const PrepareOptions& options, const Progress* progress) {
  const NeighbourGraph graph = make_estimation_graph(positions, options.neighbours, progress);
  std::vector<Vec3> of_points = estimate_normals(graph, progress);
  PreparedNormals prepared;
  prepared.orientation = orient_normals(
      graph, of_points,
      {.neighbours = std::max(static_cast<int>(graph.degree), 1), .viewpoint = options.viewpoint},
      progress);
  prepared.normals = spread_to_cloud<Vec3>(graph, of_points, Vec3::Zero());
  prepared.unusable = static_cast<std::size_t>(
      std::count_if(prepared.normals.begin(), prepared.normals.end(),
                    [](const Vec3& normal) { return normal.isZero(0.0); }));
  return prepared;
}

}  // namespace pcednet::normals
