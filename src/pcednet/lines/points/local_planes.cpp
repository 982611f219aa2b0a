#include "pcednet/lines/points/local_planes.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <limits>

#include "pcednet/core/eigendecomposition.h"
#include "pcednet/core/rank.h"
#include "pcednet/core/vector_clones.h"

namespace pcednet::lines {
namespace {

constexpr std::size_t kMostPlanes = 4;
constexpr std::size_t kMostSeeds = 16;
constexpr int kLeastSupport = 4;
constexpr double kTrusted = 0.5;  ///< edginess up to which a normal counts
constexpr double kFar = 1e9;

/// What decides whether points are on a plane.
struct Tests {
  NearPoints::Row least_cosine;  ///< of the normals; below 0: any
  NearPoints::Row taken;         ///< kFar for the points of planes found before, else 0
  int left;                      ///< the others
};

PCEDNET_VECTOR_CLONES
void set_tests(const NearPoints& points, Tests& tests) {
  for (std::size_t i = 0; i < points.count; ++i) {
    const double size = std::fabs(points.normal_x[i]) + std::fabs(points.normal_y[i]) +
                        std::fabs(points.normal_z[i]);
    const bool trusted = (points.edginess[i] <= kTrusted) & (size > 0.0);
    tests.least_cosine[i] = trusted ? kSameNormal : -1.0;
    tests.taken[i] = 0.0;
  }
  tests.left = static_cast<int>(points.count);
}

PCEDNET_VECTOR_CLONES
void take(const LocalPlane& plane, const NearPoints& points, double within, Tests& tests) {
  const double a = plane.normal.x(), b = plane.normal.y(), c = plane.normal.z();
  const double distance = plane.distance;
  for (std::size_t i = 0; i < points.count; ++i) {
    const double away = std::fabs(a * points.x[i] + b * points.y[i] + c * points.z[i] - distance);
    tests.taken[i] = larger(tests.taken[i], away < within ? kFar : 0.0);
  }
  int left = 0;
  for (std::size_t i = 0; i < points.count; ++i) left += tests.taken[i] > 0.0 ? 0 : 1;
  tests.left = left;
}

/// The points within `tolerance` of the plane that are not taken.
PCEDNET_VECTOR_CLONES
int support_of(const LocalPlane& plane, const NearPoints& points, const Tests& tests,
               double tolerance) {
  const double a = plane.normal.x(), b = plane.normal.y(), c = plane.normal.z();
  const double distance = plane.distance;
  int support = 0;
  for (std::size_t i = 0; i < points.count; ++i) {
    const double away = std::fabs(a * points.x[i] + b * points.y[i] + c * points.z[i] - distance);
    const double cosine =
        std::fabs(a * points.normal_x[i] + b * points.normal_y[i] + c * points.normal_z[i]);
    const bool near = away + tests.taken[i] <= tolerance;
    const bool agrees = cosine > tests.least_cosine[i];
    support += static_cast<int>(near) & static_cast<int>(agrees);
  }
  return support;
}

/// Sets the weights of the points near `plane`, which fall to 0 at `reach`.
PCEDNET_VECTOR_CLONES
void weigh(const LocalPlane& plane, const NearPoints& points, const Tests& tests, double reach,
           NearPoints::Row& weights) {
  const double a = plane.normal.x(), b = plane.normal.y(), c = plane.normal.z();
  const double distance = plane.distance, per_reach = 1.0 / reach;
  for (std::size_t i = 0; i < points.count; ++i) {
    const double part =
        (a * points.x[i] + b * points.y[i] + c * points.z[i] - distance) * per_reach;
    const double cosine =
        std::fabs(a * points.normal_x[i] + b * points.normal_y[i] + c * points.normal_z[i]);
    const double rest = larger(1.0 - part * part, 0.0);
    weights[i] = cosine > tests.least_cosine[i] ? rest * rest : 0.0;
  }
}

/// The plane of least squares of the points near `plane`.
LocalPlane refit(const LocalPlane& plane, const NearPoints& points, const Tests& tests,
                 double reach) {
  NearPoints::Row weights{};
  weigh(plane, points, tests, reach, weights);
  const auto refitted = plane_of(points.moments(weights), 3.0, 0.04);
  return refitted ? LocalPlane{refitted->normal, refitted->distance, plane.support} : plane;
}

/// Points with a normal, those surest not to be of an edge first.
struct Seeds {
  std::array<std::uint32_t, NearPoints::kMost> points;
  std::size_t count = 0;
};

Seeds seeds_of(const NearPoints& points) {
  constexpr double kSteps = 1 << 20;  // of edginess; then the order of the points decides
  Seeds seeds;
  std::array<std::uint32_t, NearPoints::kMost> with_normal;
  std::array<double, NearPoints::kMost + kRankStep> keys;
  std::array<std::int64_t, NearPoints::kMost + kRankStep> ranks;
  for (std::uint32_t i = 0; i < points.count; ++i) {
    if (points.normal(i).isZero(0.0)) continue;
    const double edginess = std::clamp(points.edginess[i], 0.0, 4.0);
    with_normal[seeds.count] = i;
    keys[seeds.count++] = std::floor(edginess * kSteps) * NearPoints::kMost + i;
  }
  std::fill_n(keys.begin() + seeds.count, kRankStep, std::numeric_limits<double>::infinity());
  rank(keys.data(), seeds.count, ranks.data());
  for (std::size_t k = 0; k < seeds.count; ++k) {
    seeds.points[static_cast<std::size_t>(ranks[k])] = with_normal[k];
  }
  return seeds;
}

LocalPlane best_plane(const NearPoints& points, const Tests& tests, const Seeds& seeds,
                      double tolerance) {
  LocalPlane best{Vec3::Zero(), 0.0, 0};
  std::size_t tried = 0;
  for (std::size_t k = 0; k < seeds.count && best.support < tests.left; ++k) {
    const std::size_t seed = seeds.points[k];
    if (tests.taken[seed] > 0.0) continue;
    if (tried++ == kMostSeeds) break;
    const Vec3 normal = points.normal(seed);
    LocalPlane plane{normal, normal.dot(points.offset(seed)), 0};
    plane.support = support_of(plane, points, tests, tolerance);
    if (plane.support > best.support) best = plane;
  }
  return best;
}

}  // namespace

void NearPoints::add(const Vec3& offset, const Vec3& normal, double probability) {
  x[count] = offset.x();
  y[count] = offset.y();
  z[count] = offset.z();
  normal_x[count] = normal.x();
  normal_y[count] = normal.y();
  normal_z[count] = normal.z();
  edginess[count] = probability;
  ++count;
}

std::optional<LocalPlane> plane_of(const PointMoments& moments, double least_weight,
                                   double least_width) {
  if (moments.weight < least_weight) return std::nullopt;
  const auto [variances, axes] = eigendecomposition(moments.covariance());
  if (!(variances[1] > least_width)) return std::nullopt;
  const Vec3 normal = axes.col(0).normalized();
  return LocalPlane{normal, normal.dot(moments.mean()), 0};
}

void find_planes(const NearPoints& points, double tolerance, std::vector<LocalPlane>& planes) {
  planes.clear();
  Tests tests;
  set_tests(points, tests);
  const Seeds seeds = seeds_of(points);
  while (planes.size() < kMostPlanes && tests.left >= kLeastSupport) {
    const LocalPlane best = best_plane(points, tests, seeds, tolerance);
    if (best.support < kLeastSupport) break;
    LocalPlane fitted =
        refit(refit(best, points, tests, 2.0 * tolerance), points, tests, 1.5 * tolerance);
    fitted.support = support_of(fitted, points, tests, tolerance);
    if (fitted.support < best.support) fitted = best;
    take(fitted, points, 1.3 * tolerance, tests);
    planes.push_back(fitted);
  }
}

}  // namespace pcednet::lines
