#include "pcednet/normals/prepare.h"

#include <algorithm>

#include "pcednet/cloud/bounding_box.h"
#include "pcednet/core/parallel_loops.h"

namespace pcednet::normals {
namespace {

bool is_missing(const Vec3& normal) {
  return normal.isZero(0.0);
}

OrientOptions orientation_on(const NeighbourGraph& graph, const OrientedNormalsOptions& options) {
  return {.neighbours = std::max(static_cast<int>(graph.choice.neighbours), 1),
          .viewpoint = options.viewpoint,
          .count_turned = options.count_turned};
}

}  // namespace

PreparedNormals estimate_oriented_normals(std::span<const Vec3> positions,
                                          const OrientedNormalsOptions& options,
                                          const Progress* progress) {
  check_extent(positions);
  const NeighbourGraph graph =
      make_neighbour_graph(positions, options.choice, progress, options.curve);
  std::vector<Vec3> of_points = estimate_normals(graph, progress);
  PreparedNormals prepared;
  prepared.choice = graph.choice;
  prepared.orientation = orient_points(graph, of_points, orientation_on(graph, options), progress);
  prepared.normals.resize(positions.size());
  prepared.unusable = count_where(positions.size(), [&](std::size_t i) {
    const std::uint32_t point = graph.point_of[i];
    // No zero keeps a minus sign.
    prepared.normals[i] =
        (point != kNoPoint ? of_points[point] : Vec3(Vec3::Zero())) + Vec3::Zero();
    return is_missing(prepared.normals[i]);
  });
  prepared.estimated = positions.size() - prepared.unusable;
  return prepared;
}

PreparedNormals complete_and_orient_normals(std::span<const Vec3> positions,
                                            std::span<const Vec3> given,
                                            const OrientedNormalsOptions& options,
                                            const Progress* progress) {
  check_size("normals", given.size(), positions.size());
  check_extent(positions);
  const NeighbourGraph graph =
      make_neighbour_graph(positions, options.choice, progress, options.curve);
  PreparedNormals prepared;
  prepared.choice = graph.choice;
  prepared.normals.assign(given.begin(), given.end());
  if (std::any_of(given.begin(), given.end(), is_missing)) {
    const std::vector<Vec3> of_points = estimate_normals(graph, progress);
    prepared.estimated = count_where(positions.size(), [&](std::size_t i) {
      if (!is_missing(given[i]) || graph.point_of[i] == kNoPoint) return false;
      prepared.normals[i] = of_points[graph.point_of[i]];
      return !is_missing(prepared.normals[i]);
    });
  }
  prepared.orientation =
      orient_normals(graph, positions, prepared.normals, orientation_on(graph, options), progress);
  prepared.unusable =
      count_where(positions.size(), [&](std::size_t i) { return is_missing(prepared.normals[i]); });
  return prepared;
}

}  // namespace pcednet::normals
