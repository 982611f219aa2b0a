#include "pcednet/lines/sampling.h"

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <span>
#include <vector>

#include "pcednet/core/eigendecomposition.h"
#include "pcednet/core/median.h"
#include "pcednet/lines/ordered_points.h"

namespace pcednet::lines {
namespace {

constexpr std::size_t kPlaneNeighbours = 15, kLeastNeighbours = 5;
constexpr std::size_t kSamples = 2000;     ///< points that spacing and noise are measured at
constexpr double kMostNoise = 0.7;         ///< in spacings: more is no surface
constexpr double kLeastGapOfSheets = 0.5;  ///< between the two sides of a wall, of their heights

double typical(std::vector<double> values) {
  return values.empty() ? 0.0 : upper_median(std::move(values));
}

/// Noise is everywhere: what a tenth of the points have less than half of is shape.
double noise_of(std::vector<double> distances) {
  if (distances.empty()) return 0.0;
  const double least = value_at_rank(distances, distances.size() / 10);
  return std::min(2.0 * least, upper_median(std::move(distances)));
}

/// Leaves the neighbours on the point's own side of a wall; `heights` are theirs along its normal.
/// The two sides of a wall lie apart; noise leaves no gap as wide as half of all heights.
void keep_own_sheet(std::vector<Vec3>& offsets, const std::vector<double>& heights) {
  std::vector<double> sorted = heights;
  sorted.push_back(0.0);  // the point's own
  std::sort(sorted.begin(), sorted.end());
  const double wide = kLeastGapOfSheets * (sorted.back() - sorted.front());
  const auto below = std::adjacent_find(sorted.begin(), sorted.end(),
                                        [&](double a, double b) { return b - a > wide; });
  if (below == sorted.end()) return;
  const bool is_above = *below < 0.0;  // the point's own sheet, of the gap
  std::size_t kept = 0;
  for (std::size_t i = 0; i < offsets.size(); ++i) {
    if ((heights[i] > *below) == is_above) offsets[kept++] = offsets[i];
  }
  offsets.resize(kept);
}

/// Root mean square of the distances to the plane of least squares.
double distance_to_plane(const std::vector<Vec3>& offsets) {
  const auto count = static_cast<double>(offsets.size());
  Vec3 mean = Vec3::Zero();
  for (const Vec3& offset : offsets) mean += offset;
  mean /= count;
  Mat3 covariance = Mat3::Zero();
  for (const Vec3& offset : offsets) covariance += (offset - mean) * (offset - mean).transpose();
  return std::sqrt(std::max(eigendecomposition(covariance / count).values[0], 0.0));
}

}  // namespace

Sampling measure_sampling(const OrderedPoints& cloud) {
  const std::size_t step = std::max<std::size_t>(1, cloud.size() / kSamples);
  std::vector<std::uint32_t> all, points;
  for (std::size_t i = 0; i < cloud.size(); i += step) {
    all.push_back(static_cast<std::uint32_t>(i));
    if (!cloud.is_edge(i)) points.push_back(all.back());
  }
  if (points.empty()) points = std::move(all);
  const std::size_t others = cloud.available(kPlaneNeighbours);
  std::vector<spatial::Neighbour> nearest;
  cloud.nearest_others(points, others, nearest);
  std::vector<double> spacings, noises;
  std::vector<Vec3> offsets;
  std::vector<double> heights;
  for (std::size_t k = 0; k < points.size() && others >= kLeastNeighbours; ++k) {
    const auto row = std::span(nearest).subspan(k * others, others);
    const double spacing = spacing_of(row);
    if (!(spacing > 0.0)) continue;
    spacings.push_back(spacing);
    offsets.clear(), heights.clear();
    for (const auto& near : row) {
      offsets.push_back(cloud.position(near.index) - cloud.position(points[k]));
      heights.push_back(offsets.back().dot(cloud.normal(points[k])));
    }
    keep_own_sheet(offsets, heights);
    if (offsets.size() >= kLeastNeighbours) {
      noises.push_back(distance_to_plane(offsets) / spacing);
    }
  }
  return {typical(spacings), std::min(noise_of(std::move(noises)), kMostNoise)};
}

}  // namespace pcednet::lines
