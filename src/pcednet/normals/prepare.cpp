#include "pcednet/normals/prepare.h"

#include <algorithm>
#include <atomic>

#include "pcednet/cloud/bounding_box.h"
#include "pcednet/core/parallel.h"

namespace pcednet::normals {
namespace {

bool is_missing(const Vec3& normal) {
  return normal.isZero(0.0);
}

/// The number of indices below `count` for which `work` returns true; calls it for each, on all
/// threads.
template <typename Work>
std::size_t count_where(std::size_t count, const Work& work) {
  std::atomic<std::size_t> sum = 0;
  parallel_blocks(count, 1 << 14, [&](std::size_t begin, std::size_t end) {
    std::size_t here = 0;
    for (std::size_t i = begin; i < end; ++i) here += work(i);
    sum += here;
  });
  return sum;
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
  NeighbourGraph graph = make_neighbour_graph(positions, options.choice, progress, options.curve);
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
  NeighbourGraph graph = make_neighbour_graph(positions, options.choice, progress, options.curve);
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
