#include "workbench/render/surfels.h"

#include <Eigen/Geometry>
#include <algorithm>
#include <array>
#include <cmath>
#include <utility>

#include "pcednet/cloud/bounding_box.h"
#include "pcednet/core/eigendecomposition.h"
#include "pcednet/core/median.h"
#include "pcednet/core/parallel.h"
#include "pcednet/spatial/curve_order.h"

namespace pcednet::render {
namespace {

using Eigen::Vector3f;

constexpr std::uint32_t kReached = 6;  // near points that a disc reaches
constexpr float kStrayRadius = 2.5f;   // median radii, beyond which a point may be stray
constexpr double kMostStray = 0.2;     // of all points; where more are thin, the density varies
constexpr std::size_t kBlock = 4096;

constexpr Rgb kUnlabelledColour = {150, 150, 150};

struct Points {
  std::vector<Vec3> positions;
  std::vector<std::uint32_t> sources;  ///< their indices in the cloud
};

Points finite_points(const PointCloud& cloud, std::size_t max_count) {
  const std::size_t step = (cloud.size() + max_count - 1) / max_count;
  Points points;
  for (std::size_t i = 0; i < cloud.size(); i += step) {
    if (!cloud.positions[i].allFinite()) continue;
    points.positions.push_back(cloud.positions[i]);
    points.sources.push_back(static_cast<std::uint32_t>(i));
  }
  return points;
}

/// Each place of points once: scanners give pulses without an echo one place, often (0, 0, 0).
std::vector<Vec3> distinct(const std::vector<Vec3>& positions) {
  return spatial::in_order(positions,
                           spatial::firsts_of_places(positions, spatial::curve_order(positions)));
}

void remove_outliers(Points& points) {
  const BoundingBox box = box_of_most(distinct(points.positions));
  std::size_t kept = 0;
  for (std::size_t i = 0; i < points.positions.size(); ++i) {
    if (!box.holds(points.positions[i])) continue;
    points.positions[kept] = points.positions[i];
    points.sources[kept++] = points.sources[i];
  }
  points.positions.resize(kept);
  points.sources.resize(kept);
}

void sort_along_curve(Points& points) {
  const std::vector<std::uint32_t> order = spatial::curve_order(points.positions);
  const Points unsorted = std::move(points);
  points = {};
  for (const std::uint32_t i : order) {
    points.positions.push_back(unsorted.positions[i]);
    points.sources.push_back(unsorted.sources[i]);
  }
}

UnitBox move_into_unit_box(std::vector<Vec3>& positions) {
  const BoundingBox box = bounding_box(positions);
  const Vec3 centre = box.centre();
  const double half = 0.5 * (box.max - box.min).maxCoeff();
  const double scale = half > 0.0 ? 1.0 / half : 1.0;
  for (Vec3& p : positions) p = (p - centre) * scale;
  return {.centre = centre, .half = half > 0.0 ? half : 1.0};
}

bool usable(const Vec3& normal) {
  return std::abs(normal.squaredNorm() - 1.0) < 0.5;
}

Rgb class_colour(std::uint8_t id, const ClassTable& table) {
  return id < table.size() ? table[id].colour : kUnlabelledColour;
}

/// The radius that closes the surface around a point.
float reach(const NearPoints& near) {
  return near.count > 0 ? near.distance[std::min(near.count, kReached) - 1] : 0.0f;
}

Vector3f fitted_normal(std::span<const Vec3> positions, std::size_t i, const NearPoints& near) {
  if (near.count < 2) return Vector3f::UnitZ();
  std::array<Vec3, NearPoints::kMost + 1> local;
  local[near.count] = Vec3::Zero();
  Vec3 mean = Vec3::Zero();
  for (std::size_t k = 0; k < near.count; ++k) {
    local[k] = (positions[near.index[k]] - positions[i]) / near.distance[near.count - 1];
    mean += local[k] / (near.count + 1);
  }
  Mat3 covariance = Mat3::Zero();
  for (std::size_t k = 0; k <= near.count; ++k) {
    covariance += (local[k] - mean) * (local[k] - mean).transpose();
  }
  const Vec3 normal = eigendecomposition(covariance).vectors.col(0);
  return normal.allFinite() ? Vector3f(normal.normalized().cast<float>()) : Vector3f::UnitZ();
}

/// Evens out radii and normals: each radius becomes the median of those around it, so that no disc
/// is much larger than its neighbours, each normal the mean of similar ones.
void smooth(std::vector<Surfel>& surfels, const std::vector<NearPoints>& near) {
  const std::vector<Surfel> rough = surfels;
  parallel_blocks(surfels.size(), kBlock, [&](std::size_t begin, std::size_t end) {
    for (std::size_t i = begin; i < end; ++i) {
      std::array<float, NearPoints::kMost + 1> radii;
      const std::size_t count = near[i].count;
      radii[count] = rough[i].radius;
      Vector3f normal = rough[i].normal;
      for (std::size_t k = 0; k < count; ++k) {
        const Surfel& other = rough[near[i].index[k]];
        radii[k] = other.radius;
        const float cosine = rough[i].normal.dot(other.normal);
        normal += cosine * std::abs(cosine * cosine * cosine) * other.normal;
      }
      std::nth_element(radii.begin(), radii.begin() + count / 2, radii.begin() + count + 1);
      surfels[i].radius = std::min(radii[count / 2], 1.5f * rough[i].radius);
      surfels[i].normal = normal.normalized();
    }
  });
}

/// Drops the points that are much sparser than most, unless these are many.
void drop_strays(std::vector<Surfel>& surfels, const std::vector<NearPoints>& near) {
  std::vector<float> radii(near.size());
  std::transform(near.begin(), near.end(), radii.begin(), reach);
  const auto at = [&](double share) {
    return value_at_rank(radii,
                         static_cast<std::size_t>(share * static_cast<double>(radii.size() - 1)));
  };
  const float largest = kStrayRadius * at(0.5);
  if (largest == 0.0f || at(1.0 - kMostStray) > largest) return;
  std::size_t kept = 0;
  for (std::size_t i = 0; i < surfels.size(); ++i) {
    if (reach(near[i]) <= largest) surfels[kept++] = surfels[i];
  }
  surfels.resize(kept);
}

/// Moves and scales all, so that they just lie in [-1, 1]^3.
UnitBox fill_unit_box(std::vector<Surfel>& surfels) {
  std::vector<Vec3> positions;
  for (const Surfel& surfel : surfels) positions.push_back(surfel.position.cast<double>());
  const BoundingBox box = bounding_box(positions);
  const float half = 0.5f * static_cast<float>((box.max - box.min).maxCoeff());
  const Vector3f centre = box.centre().cast<float>();
  for (Surfel& surfel : surfels) {
    surfel.position -= centre;
    if (half > 0.0f) surfel.position /= half, surfel.radius /= half;
  }
  return {.centre = centre.cast<double>(), .half = half > 0.0f ? half : 1.0};
}

constexpr std::size_t kWindow = 8;  // points to each side along each curve
constexpr std::size_t kCurves = 3;
constexpr std::size_t kQueriesAtOnce = 4096;

struct Candidate {
  double sq_distance;
  std::uint32_t index;
  bool operator==(const Candidate&) const = default;
  bool operator<(const Candidate& other) const {
    if (sq_distance != other.sq_distance) return sq_distance < other.sq_distance;
    return index < other.index;
  }
};

/// A curve through the points, turned a little, so that no two curves are cut at the same places.
struct Curve {
  std::vector<std::uint32_t> order, rank;

  Curve(std::span<const Vec3> positions, double turn) : rank(positions.size()) {
    const Mat3 rotation(Eigen::AngleAxisd(turn, Vec3(0.48, 0.60, 0.64)));
    std::vector<Vec3> turned(positions.begin(), positions.end());
    for (Vec3& p : turned) p = rotation * p;
    order = spatial::curve_order(turned);
    for (std::size_t i = 0; i < order.size(); ++i) rank[order[i]] = static_cast<std::uint32_t>(i);
  }
};

/// The least candidates seen so far, sorted, each once.
struct Least {
  std::array<Candidate, NearPoints::kMost> found;
  std::size_t count = 0;

  void offer(const Candidate& candidate) {
    if (count == found.size() && !(candidate < found.back())) return;
    std::size_t place = count;
    while (place > 0 && candidate < found[place - 1]) --place;
    if (place > 0 && candidate == found[place - 1]) return;
    count = std::min(count + 1, found.size());
    for (std::size_t k = count - 1; k > place; --k) found[k] = found[k - 1];
    found[place] = candidate;
  }
};

NearPoints nearest(std::span<const Vec3> positions, std::span<const Curve> curves, std::size_t i) {
  Least least;
  for (const Curve& curve : curves) {
    const std::size_t rank = curve.rank[i];
    const std::size_t begin = rank > kWindow ? rank - kWindow : 0;
    const std::size_t end = std::min(positions.size(), rank + kWindow + 1);
    for (std::size_t r = begin; r < end; ++r) {
      const std::uint32_t other = curve.order[r];
      const double sq_distance = (positions[other] - positions[i]).squaredNorm();
      if (sq_distance > 0.0) least.offer({sq_distance, other});
    }
  }
  NearPoints near;
  near.count = static_cast<std::uint32_t>(least.count);
  for (std::size_t k = 0; k < least.count; ++k) {
    near.index[k] = least.found[k].index;
    near.distance[k] = static_cast<float>(std::sqrt(least.found[k].sq_distance));
  }
  return near;
}

}  // namespace

std::vector<Surfel> make_surfels(const PointCloud& cloud, std::span<const std::uint8_t> classes,
                                 std::size_t max_count, UnitBox* box, const ClassTable& table) {
  Points points = finite_points(cloud, max_count);
  if (points.positions.empty()) return {};
  remove_outliers(points);
  sort_along_curve(points);
  const UnitBox all = move_into_unit_box(points.positions);
  const std::vector<NearPoints> near = near_points(points.positions);

  const bool edges = !classes.empty() && has_edges(table);
  std::vector<Surfel> surfels(points.positions.size());
  parallel_blocks(surfels.size(), kBlock, [&](std::size_t begin, std::size_t end) {
    for (std::size_t i = begin; i < end; ++i) {
      const std::size_t source = points.sources[i];
      Surfel& surfel = surfels[i];
      surfel.position = points.positions[i].cast<float>();
      surfel.radius = reach(near[i]);
      surfel.normal = cloud.has_normals() && usable(cloud.normals[source])
                          ? Vector3f(cloud.normals[source].normalized().cast<float>())
                          : fitted_normal(points.positions, i, near[i]);
      surfel.colour = !classes.empty()         ? class_colour(classes[source], table)
                      : !cloud.colours.empty() ? cloud.colours[source]
                                               : kEdgeClasses[kNonEdge].colour;
      surfel.edge = edges && classes[source] != kNonEdge && classes[source] < kEdgeClasses.size();
    }
  });
  smooth(surfels, near);
  drop_strays(surfels, near);
  const UnitBox kept = fill_unit_box(surfels);
  if (box) *box = {.centre = all.centre + all.half * kept.centre, .half = all.half * kept.half};
  return surfels;
}

std::vector<NearPoints> near_points(std::span<const Vec3> positions) {
  std::vector<Curve> curves;
  for (std::size_t c = 0; c < kCurves; ++c) curves.emplace_back(positions, 0.7 * c);
  std::vector<NearPoints> near(positions.size());
  parallel_blocks(positions.size(), kQueriesAtOnce, [&](std::size_t begin, std::size_t end) {
    for (std::size_t i = begin; i < end; ++i) near[i] = nearest(positions, curves, i);
  });
  return near;
}

}  // namespace pcednet::render
