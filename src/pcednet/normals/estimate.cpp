#include "pcednet/normals/estimate.h"

#include <map>

#include "pcednet/core/parallel.h"
#include "pcednet/normals/exact_planes.h"
#include "pcednet/normals/local_counts.h"
#include "pcednet/normals/plane_fit.h"

namespace pcednet::normals {

std::vector<Vec3> estimate_normals(const NeighbourGraph& graph, const Progress* progress) {
  std::vector<Vec3> normals(graph.points.size());
  const std::vector<std::uint32_t> counts = local_counts(graph, progress);
  Stage stage(progress, "normals", normals.size());
  parallel_blocks(normals.size(), 1024, [&](std::size_t begin, std::size_t end) {
    std::map<std::size_t, std::vector<std::uint32_t>> by_count;
    for (std::size_t i = begin; i < end; ++i) {
      by_count[counts[i]].push_back(static_cast<std::uint32_t>(i));
    }
    for (const auto& [count, some] : by_count) {
      const std::vector<PlaneFit> planes = fit_planes(graph, some, count);
      for (std::size_t k = 0; k < some.size(); ++k) normals[some[k]] = planes[k].normal;
    }
    for (std::size_t i = begin; graph.choice.exact_planes && i < end; ++i) {
      const Vec3 exact = exact_normal(graph.points, i, graph.of(i));
      if (!exact.isZero(0.0)) normals[i] = exact;
    }
    stage.advance(end - begin);
  });
  return normals;
}

std::vector<Vec3> estimate_normals(std::span<const Vec3> positions,
                                   std::optional<NeighbourChoice> choice,
                                   const Progress* progress) {
  const NeighbourGraph graph = make_neighbour_graph(positions, choice, progress);
  const std::vector<Vec3> of_points = estimate_normals(graph, progress);
  std::vector<Vec3> normals(positions.size(), Vec3::Zero());
  for (std::size_t i = 0; i < positions.size(); ++i) {
    if (graph.point_of[i] != kNoPoint) normals[i] = of_points[graph.point_of[i]];
  }
  return normals;
}

}  // namespace pcednet::normals
