#include "workbench/classic/edge_measure.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "pcednet/core/error.h"
#include "pcednet/core/median.h"
#include "workbench/classic/surface_variation.h"

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

}  // namespace pcednet::classic
