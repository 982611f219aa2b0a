#include "pcednet/normals/estimate.h"

#include <numeric>

#include "pcednet/core/parallel.h"
#include "pcednet/normals/exact_planes.h"
#include "pcednet/normals/plane_fit.h"

namespace pcednet::normals {
namespace {

/// The neighbours that planes are fitted to, of the points from `begin` to `end`.
std::vector<std::uint32_t> nearest_rows(const NeighbourGraph& graph, std::size_t begin,
                                        std::size_t end) {
  std::vector<std::uint32_t> rows;
  rows.reserve((end - begin) * graph.choice.neighbours);
  for (std::size_t i = begin; i < end; ++i) {
    const auto row = graph.of(i).first(graph.choice.neighbours);
    rows.insert(rows.end(), row.begin(), row.end());
  }
  return rows;
}

}  // namespace

std::vector<Vec3> estimate_normals(const NeighbourGraph& graph, const Progress* progress) {
  std::vector<Vec3> normals(graph.points.size());
  Stage stage(progress, "normals", normals.size());
  parallel_blocks(normals.size(), 1024, [&](std::size_t begin, std::size_t end) {
    std::vector<std::uint32_t> some(end - begin);
    std::iota(some.begin(), some.end(), static_cast<std::uint32_t>(begin));
    std::vector<PlaneFit> fits(some.size());
    if (graph.choice.neighbours < graph.degree) {
      fit_planes(graph.points, some, nearest_rows(graph, begin, end), fits);
    } else {
      fit_planes(
          graph.points, some,
          std::span(graph.neighbours).subspan(begin * graph.degree, fits.size() * graph.degree),
          fits);
    }
    for (std::size_t i = begin; i < end; ++i) {
      normals[i] = graph.choice.exact_planes ? exact_normal(graph.points, i, graph.of(i))
                                             : Vec3(Vec3::Zero());
      if (normals[i].isZero(0.0)) normals[i] = fits[i - begin].normal;
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
