#include "pcednet/normals/prepare.h"

#include <algorithm>

#include "pcednet/cloud/bounding_box.h"

namespace pcednet::normals {

PreparedNormals estimate_oriented_normals(std::span<const Vec3> positions,
                                          const PrepareOptions& options, const Progress* progress) {
  const std::vector<Vec3> none(positions.size(), Vec3::Zero());
  return complete_and_orient_normals(positions, none, options, progress);
}

PreparedNormals complete_and_orient_normals(std::span<const Vec3> positions,
                                            std::span<const Vec3> given,
                                            const PrepareOptions& options,
                                            const Progress* progress) {
  const auto is_missing = [](const Vec3& normal) { return normal.isZero(0.0); };
  check_size(positions, given);
  check_extent(positions);
  const NeighbourGraph graph = make_estimation_graph(positions, options.neighbours, progress);
  PreparedNormals prepared;
  prepared.neighbours = graph.degree;
  prepared.normals.assign(given.begin(), given.end());
  if (std::any_of(given.begin(), given.end(), is_missing)) {
    const std::vector<Vec3> of_points = estimate_normals(graph, progress);
    for (std::size_t i = 0; i < given.size(); ++i) {
      if (!is_missing(given[i]) || graph.point_of[i] == kNoPoint) continue;
      prepared.normals[i] = of_points[graph.point_of[i]];
      if (!is_missing(prepared.normals[i])) ++prepared.estimated;
    }
  }
  const int neighbours = std::max(static_cast<int>(graph.degree), 1);
  prepared.orientation = orient_normals(graph, positions, prepared.normals,
                                        {.neighbours = neighbours,
                                         .viewpoint = options.viewpoint,
                                         .count_turned = options.count_turned},
                                        progress);
  prepared.unusable = static_cast<std::size_t>(
      std::count_if(prepared.normals.begin(), prepared.normals.end(), is_missing));
  return prepared;
}

}  // namespace pcednet::normals
