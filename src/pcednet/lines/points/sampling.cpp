#include "pcednet/lines/points/sampling.h"

#include <Eigen/Geometry>
#include <Eigen/QR>
#include <algorithm>
#include <cmath>
#include <cstdint>
#include <iterator>
#include <numeric>
#include <span>
#include <vector>

#include "pcednet/cloud/coordinate_step.h"
#include "pcednet/core/median.h"
#include "pcednet/lines/points/ordered_points.h"
#include "pcednet/lines/points/plane_sums.h"

namespace pcednet::lines {
namespace {

constexpr std::size_t kPlaneNeighbours = 15, kLeastNeighbours = 5;
constexpr std::size_t kMoreNeighbours = 32;
constexpr std::size_t kSamples = 2000;  ///< points that spacing and noise are measured at
constexpr std::size_t kFewSamples = 50;
constexpr double kUneven = 1.5;            ///< times the spacing
constexpr double kMostNoise = 0.7;         ///< in spacings: more is no surface
constexpr double kLeastGapOfSheets = 0.5;  ///< between the two sides of a wall, of their heights
constexpr double kLeastStep = 0.05;        ///< of rounded coordinates, in spacings
constexpr std::size_t kOnOwnSide = 3;      ///< nearest others, hardly ever beyond a wall
constexpr double kLikeNormals = 0.75;      ///< mean cosine where the surface is flat
constexpr double kLayered = 2.1;           ///< least noise of several layers, by that of one
constexpr double kLeastOfLayers = 0.15, kMostOfLayers = 0.6;  ///< in spacings
constexpr double kMostOpposed = 0.15;                         ///< of these, where signs agree

/// A point and its nearest others.
struct PlaneSample {
  double spacing;
  double noise;         ///< of them about their plane; below 0: unknown
  std::size_t opposed;  ///< of the nearest kOnOwnSide
};

double typical_spacing(const std::vector<PlaneSample>& samples) {
  std::vector<double> spacings;
  for (const PlaneSample& sample : samples) spacings.push_back(sample.spacing);
  return spacings.empty() ? 0.0 : upper_median(std::move(spacings));
}

/// In spacings. Noise is everywhere: what a tenth of the points have less than half of is shape.
double noise_of(const std::vector<PlaneSample>& samples) {
  std::vector<double> noises;
  for (const PlaneSample& sample : samples) {
    if (sample.noise >= 0.0) noises.push_back(sample.noise / sample.spacing);
  }
  if (noises.empty()) return 0.0;
  const double least = value_at_rank(noises, noises.size() / 10);
  return std::min({2.0 * least, upper_median(std::move(noises)), kMostNoise});
}

bool are_oriented(const std::vector<PlaneSample>& samples) {
  std::size_t opposed = 0;
  for (const PlaneSample& sample : samples) opposed += sample.opposed;
  return static_cast<double>(opposed) <=
         kMostOpposed * static_cast<double>(kOnOwnSide * samples.size());
}

/// The samples where the spacing is about this one; if they are few, all, as if it were theirs.
std::vector<PlaneSample> like(const std::vector<PlaneSample>& samples, double spacing) {
  std::vector<PlaneSample> alike, scaled;
  for (const PlaneSample& sample : samples) {
    const double ratio = sample.spacing / spacing;
    if (ratio < kUneven && ratio * kUneven > 1.0) alike.push_back(sample);
    scaled.push_back({spacing, sample.noise, sample.opposed});
  }
  return alike.size() < kFewSamples ? scaled : alike;
}

/// About kSamples of these.
std::vector<std::uint32_t> some_of(const std::vector<std::uint32_t>& points) {
  const std::size_t step = std::max<std::size_t>(1, points.size() / kSamples);
  std::vector<std::uint32_t> some;
  for (std::size_t i = 0; i < points.size(); i += step) some.push_back(points[i]);
  return some;
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

std::vector<PlaneSample> samples_at(const OrderedPoints& cloud,
                                    const std::vector<std::uint32_t>& points) {
  const std::size_t others = cloud.available(kPlaneNeighbours);
  std::vector<PlaneSample> samples;
  if (others < kLeastNeighbours) return samples;
  std::vector<spatial::Neighbour> nearest;
  cloud.nearest_others(points, others, nearest);
  std::vector<Vec3> offsets;
  std::vector<double> heights;
  for (std::size_t k = 0; k < points.size(); ++k) {
    const auto row = std::span(nearest).subspan(k * others, others);
    const double spacing = spacing_of(row);
    if (!(spacing > 0.0)) continue;
    offsets.clear(), heights.clear();
    for (const auto& near : row) {
      offsets.push_back(cloud.position(near.index) - cloud.position(points[k]));
      heights.push_back(offsets.back().dot(cloud.normal(points[k])));
    }
    keep_own_sheet(offsets, heights);
    PlaneSums own_sheet;
    for (const Vec3& offset : offsets) own_sheet.add(offset);
    const bool enough = offsets.size() >= kLeastNeighbours;
    const auto opposed =
        std::count_if(row.begin(), row.begin() + kOnOwnSide,
                      [&](const auto& near) { return cloud.face_away(points[k], near.index); });
    samples.push_back({spacing, enough ? fit_plane(own_sheet).residual : -1.0,
                       static_cast<std::size_t>(opposed)});
  }
  return samples;
}

/// Whether a point has about the normal of these: not on rods and thin walls.
bool has_like_normal(const OrderedPoints& cloud, std::uint32_t point,
                     std::span<const spatial::Neighbour> others) {
  double cosines = 0.0;
  for (const spatial::Neighbour& near : others) {
    if (cloud.face_away(point, near.index)) continue;
    cosines += std::abs(cloud.normal(point).dot(cloud.normal(near.index)));
  }
  return cosines > kLikeNormals * static_cast<double>(others.size());
}

/// The root mean square distance of places from a paraboloid of least squares; `normal` is across.
double bent_residual(const std::vector<Vec3>& places, const Vec3& normal) {
  const Vec3 u = normal.unitOrthogonal(), v = normal.cross(u);
  Eigen::Matrix<double, Eigen::Dynamic, 6> terms(places.size(), 6);
  Eigen::VectorXd heights(places.size());
  for (std::size_t i = 0; i < places.size(); ++i) {
    const double x = u.dot(places[i]), y = v.dot(places[i]);
    const auto row = static_cast<Eigen::Index>(i);
    terms.row(row) << 1.0, x, y, x * x, x * y, y * y;
    heights[row] = normal.dot(places[i]);
  }
  const Eigen::VectorXd fitted = terms * terms.colPivHouseholderQr().solve(heights);
  return (heights - fitted).norm() / std::sqrt(static_cast<double>(places.size()));
}

/// Of the points with like normals, the noise about a bent surface, whatever layer others are of;
/// those beyond a thin wall, which face away, are of none.
std::vector<PlaneSample> bent_samples_at(const OrderedPoints& cloud,
                                         const std::vector<std::uint32_t>& points) {
  std::vector<spatial::Neighbour> nearest;
  cloud.nearest_others(points, kMoreNeighbours, nearest);
  std::vector<PlaneSample> samples;
  std::vector<Vec3> offsets;
  for (std::size_t k = 0; k < points.size(); ++k) {
    const auto row = std::span(nearest).subspan(k * kMoreNeighbours, kMoreNeighbours);
    const double spacing = spacing_of(row);
    if (!(spacing > 0.0) || !has_like_normal(cloud, points[k], row)) continue;
    PlaneSums sums;
    offsets.clear();
    for (const spatial::Neighbour& near : row) {
      if (cloud.face_away(points[k], near.index)) continue;
      offsets.push_back(cloud.position(near.index) - cloud.position(points[k]));
      sums.add(offsets.back());
    }
    samples.push_back({spacing, bent_residual(offsets, fit_plane(sums).normal), 0});
  }
  return samples;
}

/// The noise of a cloud of several layers about a spacing apart, as of scans that are not aligned;
/// of others, this one, which is that of the points' own layers.
double noise_of_layers(const OrderedPoints& cloud, const std::vector<std::uint32_t>& points,
                       double noise) {
  if (cloud.available(kMoreNeighbours) < kMoreNeighbours) return noise;
  const std::vector<PlaneSample> samples = bent_samples_at(cloud, points);
  if (samples.size() < kFewSamples) return noise;
  const double of_all = noise_of(samples);
  const bool layered = of_all > kLeastOfLayers && of_all > kLayered * noise;
  return layered ? std::min(of_all, kMostOfLayers) : noise;
}

/// Whether coordinates are multiples of a step: the planes of voxels are not those of the surface.
bool is_rounded(const OrderedPoints& cloud, const std::vector<std::uint32_t>& points,
                double spacing) {
  std::vector<Vec3> positions;
  for (const std::uint32_t i : points) positions.push_back(cloud.position(i));
  std::vector<std::uint32_t> each(positions.size());
  std::iota(each.begin(), each.end(), 0u);
  return coordinate_step(positions, each) > kLeastStep * spacing;
}

}  // namespace

Sampling measure_sampling(const OrderedPoints& cloud) {
  std::vector<std::uint32_t> all(cloud.size()), on, off;
  std::iota(all.begin(), all.end(), 0u);
  const auto is_edge = [&](std::uint32_t i) { return cloud.is_edge(i); };
  std::copy_if(all.begin(), all.end(), std::back_inserter(on), is_edge);
  all = some_of(all);
  std::remove_copy_if(all.begin(), all.end(), std::back_inserter(off), is_edge);
  // Where nearly all points are of edges the few others tell nothing of them.
  const std::vector<std::uint32_t>& most = off.size() < kFewSamples ? all : off;
  const std::vector<PlaneSample> around = samples_at(cloud, most);
  const double spacing = typical_spacing(around);
  const double at_edges = typical_spacing(samples_at(cloud, some_of(on)));
  Sampling sampling{.spacing = spacing, .noise = 0.0, .oriented = are_oriented(around)};
  if (at_edges < kUneven * spacing) {
    sampling.noise = noise_of(around);
    if (sampling.oriented) sampling.noise = noise_of_layers(cloud, most, sampling.noise);
  } else {
    sampling.spacing = at_edges;
    sampling.noise = noise_of(like(around, at_edges));
  }
  sampling.exact = sampling.noise < kExactNoise && !is_rounded(cloud, all, sampling.spacing);
  return sampling;
}

}  // namespace pcednet::lines
