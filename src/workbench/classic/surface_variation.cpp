#include "workbench/classic/surface_variation.h"

#include <fmt/format.h>

#include <Eigen/Eigenvalues>
#include <algorithm>
#include <limits>

#include "pcednet/core/error.h"
#include "pcednet/core/parallel.h"
#include "pcednet/spatial/kd_tree.h"

namespace pcednet::classic {
namespace {

double variation(std::span<const Vec3> positions, std::span<const spatial::Neighbour> near) {
  const Vec3& origin = positions[near.front().index];  // large coordinates cancel here
  Vec3 mean = Vec3::Zero();
  for (const auto& neighbour : near) mean += positions[neighbour.index] - origin;
  mean /= static_cast<double>(near.size());
  Mat3 covariance = Mat3::Zero();
  for (const auto& neighbour : near) {
    const Vec3 offset = positions[neighbour.index] - origin - mean;
    covariance += offset * offset.transpose();
  }
  const double trace = covariance.trace();
  if (!(trace > 0.0)) return 0.0;
  const Eigen::SelfAdjointEigenSolver<Mat3> solver(covariance / trace, Eigen::EigenvaluesOnly);
  return std::clamp(solver.eigenvalues()[0], 0.0, 1.0 / 3.0);
}

}  // namespace

std::vector<double> surface_variation(std::span<const Vec3> positions, int neighbours,
                                      const Progress* progress) {
  if (neighbours < 4) {
    throw Error(
        ErrorKind::kUsage,
        fmt::format("surface variation: {} neighbours are too few, give 4 or more", neighbours));
  }
  const spatial::KdTree tree(positions);
  const auto count = static_cast<std::size_t>(neighbours);
  if (tree.size() < count) {
    throw Error(ErrorKind::kInsufficient,
                fmt::format("{} finite points are too few for {} neighbours", tree.size(), count));
  }
  std::vector<double> values(positions.size(), std::numeric_limits<double>::quiet_NaN());
  Stage stage(progress, "surface variation", positions.size());
  parallel_blocks(positions.size(), 4096, [&](std::size_t begin, std::size_t end) {
    std::vector<spatial::Neighbour> near;
    for (std::size_t i = begin; i < end; ++i) {
      if (!positions[i].allFinite()) continue;
      throw_if_cancelled(progress);  // with many neighbours a point takes long
      tree.nearest(positions[i], count, near);
      values[i] = variation(positions, near);
    }
    stage.advance(end - begin);
  });
  return values;
}

}  // namespace pcednet::classic
