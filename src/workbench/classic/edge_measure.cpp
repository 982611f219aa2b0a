#include "workbench/classic/edge_measure.h"

#include <fmt/format.h>
#include <Eigen/Eigenvalues>
#include <algorithm>
#include <cmath>
#include <limits>

#include "pcednet/core/error.h"
#include "pcednet/core/median.h"
#include "pcednet/core/parallel.h"
#include "pcednet/spatial/kd_tree.h"

namespace pcednet::classic {
namespace {

void check(double threshold) {
  if (threshold >= 0.0) return;
  throw Error(ErrorKind::kUsage, fmt::format("a threshold of {} is not 0 or more", threshold));
}

/// Over the values that are not NaN, summed in sorted order: the same for any order of points.
double standard_deviation(std::vector<double> values) {
  std::erase_if(values, [](double v) { return std::isnan(v); });
  std::sort(values.begin(), values.end());
  double mean = 0.0, sum = 0.0;
  for (const double v : values) mean += v / static_cast<double>(values.size());
  for (const double v : values) sum += (v - mean) * (v - mean);
  return std::sqrt(sum / static_cast<double>(values.size()));
}

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

EdgeMeasure covariance_analysis(std::span<const Vec3> positions,
                                const CovarianceAnalysisOptions& options,
                                const Progress* progress) {
  check(options.threshold);
  EdgeMeasure measure = {.values = surface_variation(positions, options.neighbours, progress)};
  measure.threshold = options.threshold * 2.0 * standard_deviation(measure.values);
  return measure;
}

EdgeMeasure multi_scale_variation(std::span<const Vec3> positions, const MultiScaleOptions& options,
                                  const Progress* progress) {
  check(options.threshold);
  if (options.neighbours.empty()) {
    throw Error(ErrorKind::kUsage, "multi-scale surface variation: no neighbourhoods");
  }
  std::vector<std::vector<double>> scales;
  for (const int neighbours : options.neighbours) {
    const bool fits = static_cast<std::size_t>(neighbours) <= positions.size() / 4;
    if (fits || scales.empty()) {
      scales.push_back(surface_variation(positions, neighbours, progress));
    }
  }
  EdgeMeasure measure = {.values = std::vector<double>(positions.size()),
                         .threshold = options.threshold};
  std::vector<double> values(scales.size());
  for (std::size_t i = 0; i < positions.size(); ++i) {
    for (std::size_t s = 0; s < scales.size(); ++s) values[s] = scales[s][i];
    measure.values[i] = std::isnan(values.front()) ? values.front() : median(values);
  }
  return measure;
}

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
