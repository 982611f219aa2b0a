#include "pcednet/normals/estimate.h"

#include <fmt/format.h>

#include <Eigen/Eigenvalues>

#include "pcednet/core/error.h"
#include "pcednet/core/parallel.h"

namespace pcednet::normals {
namespace {

/// Second eigenvalue over the largest below which a neighbourhood is taken for a line: a width of
/// 1e-5 of the length.
constexpr double kLine = 1e-10;

/// Compares sums of products of eigenvalues, which have no rounding error to speak of where the
/// eigenvalues themselves, from the closed form, are good to 1e-8 of the largest only.
bool is_line(const Mat3& c) {
  const double pairs = c(0, 0) * c(1, 1) - c(0, 1) * c(0, 1) + c(0, 0) * c(2, 2) -
                       c(0, 2) * c(0, 2) + c(1, 1) * c(2, 2) - c(1, 2) * c(1, 2);
  return !(pairs > kLine * c.trace() * c.trace());
}

Vec3 fit_normal(const NeighbourGraph& graph, std::size_t point) {
  const auto neighbours = graph.of(point);
  if (neighbours.size() < 2) return Vec3::Zero();
  // Offsets from the point, not positions: nothing is lost far from the origin.
  const Vec3 centre = graph.points[point];
  const double sq_radius = 1.05 * (graph.points[neighbours.back()] - centre).squaredNorm();
  double sum_weights = 1.0;
  Vec3 sum = Vec3::Zero();
  Mat3 products = Mat3::Zero();
  for (const std::uint32_t j : neighbours) {
    const Vec3 offset = graph.points[j] - centre;
    const double falloff = 1.0 - offset.squaredNorm() / sq_radius;
    const double weight = falloff * falloff;
    sum_weights += weight;
    sum += weight * offset;
    products += weight * offset * offset.transpose();
  }
  const Mat3 covariance = products - sum * sum.transpose() / sum_weights;
  if (is_line(covariance)) return Vec3::Zero();
  Eigen::SelfAdjointEigenSolver<Mat3> solver;
  solver.computeDirect(covariance);
  return solver.eigenvectors().col(0).normalized();
}

}  // namespace

std::vector<Vec3> estimate_normals(const NeighbourGraph& graph, const Progress* progress) {
  std::vector<Vec3> normals(graph.points.size());
  Stage stage(progress, "normals", normals.size());
  parallel_blocks(normals.size(), 1024, [&](std::size_t begin, std::size_t end) {
    for (std::size_t i = begin; i < end; ++i) normals[i] = fit_normal(graph, i);
    stage.advance(end - begin);
  });
  return normals;
}

std::vector<Vec3> estimate_normals(std::span<const Vec3> positions, const EstimateOptions& options,
                                   const Progress* progress) {
  if (options.neighbours < 2) {
    throw Error(ErrorKind::kUsage,
                fmt::format("a normal needs at least 2 neighbours, not {}", options.neighbours));
  }
  const NeighbourGraph graph =
      make_neighbour_graph(positions, static_cast<std::size_t>(options.neighbours), progress);
  const std::vector<Vec3> normals = estimate_normals(graph, progress);
  return spread_to_cloud<Vec3>(graph, normals, Vec3::Zero());
}

}  // namespace pcednet::normals
