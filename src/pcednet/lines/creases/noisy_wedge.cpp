#include "pcednet/lines/creases/noisy_wedge.h"

#include <Eigen/Dense>
#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <limits>
#include <numbers>

#include "pcednet/core/half_space.h"
#include "pcednet/core/vector_clones.h"
#include "pcednet/lines/creases/quadric.h"
#include "pcednet/lines/points/lanes.h"
#include "pcednet/lines/points/plane_line.h"

namespace pcednet::lines {
namespace {

constexpr std::size_t kFewestPoints = 14;
constexpr int kFewestOfSide = 5;
constexpr double kSmallestAngle = 22.0 * std::numbers::pi / 180.0;
constexpr int kDirections = 10;   ///< even
constexpr std::size_t kCuts = 9;  ///< of each direction
constexpr int kImprovements = 3;
constexpr double kByRounding = 1e-9;     ///< of errors of the same parts, cut in two directions
constexpr double kMostOutliers = 0.12;   ///< share of the points
constexpr double kPrice = 2.0;           ///< in squared standard deviations: of the choice of a cut
constexpr double kMostMeanSquare = 1.7;  ///< of the distances, in squared standard deviations

// In spacings.
constexpr double kCutStep = 0.5;    ///< from one cut to the next
constexpr double kFromPoint = 2.2;  ///< of the line from the origin

constexpr double kBeyondNoise = 0.06;  ///< of a smooth surface from its points
constexpr double kSqOutlierOfSmooth = 1.0;

/// Of the squared distances to half-planes, what those to a smooth surface are at most.
constexpr double kShareOfSmooth = 0.5;

// In standard deviations.
constexpr double kOutlier = 3.0;

struct HalfPlanes {
  LocalPlane a, b;
  Wedge wedge;
};

/// The half-planes of two planes, each on the side of a point of its part.
std::optional<HalfPlanes> half_planes(const LocalPlane& a, const LocalPlane& b, const Vec3& of_a,
                                      const Vec3& of_b) {
  const auto line =
      line_of_planes(a.normal, a.distance, b.normal, b.distance, std::sin(kSmallestAngle));
  if (!line) return std::nullopt;
  const auto towards = [&](const Vec3& normal, const Vec3& place) {
    return turned_to(line->along.cross(normal), place - line->point);
  };
  return HalfPlanes{
      a, b, {line->point, line->along, towards(a.normal, of_a), towards(b.normal, of_b)}};
}

/// The parts of the points before and after each cut, in a row each, so that a vector has a part
/// per lane.
struct Parts {
  static constexpr std::size_t kCount = 2 * kCuts;
  using Row = std::array<double, kCount>;

  Row weight, x, y, z, xx, xy, yy, xz, yz, zz;  ///< their moments
  Row slope_x, slope_y;  ///< of their least-squares planes, as heights z over x and y
  Row error;  ///< sums of squared distances to these; infinite for a part too small or too narrow

  void set(std::size_t i, const PointMoments& m) {
    weight[i] = m.weight, x[i] = m.x, y[i] = m.y, z[i] = m.z;
    xx[i] = m.xx, xy[i] = m.xy, yy[i] = m.yy, xz[i] = m.xz, yz[i] = m.yz, zz[i] = m.zz;
  }
  Vec3 mean(std::size_t i) const { return Vec3(x[i], y[i], z[i]) / weight[i]; }
  LocalPlane plane(std::size_t i, const Frame& frame) const {
    const Vec3 normal = (frame.z - slope_x[i] * frame.x - slope_y[i] * frame.y).normalized();
    return {normal, normal.dot(frame.place(mean(i))), 0};
  }
};

PCEDNET_VECTOR_CLONES
void fit_planes(Parts& parts) {
  constexpr double kLeastSpread = 0.02;  // of the points of a part over x and y
  constexpr double kInfinity = std::numeric_limits<double>::infinity();
  for (std::size_t i = 0; i < Parts::kCount; ++i) {
    const double weight = parts.weight[i], x = parts.x[i], y = parts.y[i], z = parts.z[i];
    const double per_weight = 1.0 / weight;
    const double mean_x = x * per_weight, mean_y = y * per_weight, mean_z = z * per_weight;
    const double xx = parts.xx[i] - x * mean_x, xy = parts.xy[i] - x * mean_y;
    const double yy = parts.yy[i] - y * mean_y, zz = parts.zz[i] - z * mean_z;
    const double xz = parts.xz[i] - z * mean_x, yz = parts.yz[i] - z * mean_y;
    const double determinant = xx * yy - xy * xy;
    const double per_determinant = 1.0 / determinant;
    const double slope_x = (xz * yy - yz * xy) * per_determinant;
    const double slope_y = (yz * xx - xz * xy) * per_determinant;
    const double error = larger(0.0, zz - slope_x * xz - slope_y * yz) /
                         (1.0 + slope_x * slope_x + slope_y * slope_y);
    const bool sound = (weight >= static_cast<double>(kFewestOfSide)) &
                       (determinant > kLeastSpread * weight * weight);
    parts.slope_x[i] = slope_x, parts.slope_y[i] = slope_y;
    parts.error[i] = sound ? error : kInfinity;
  }
}

/// Framed points with the moments of each.
struct CutPoints : FramedPoints {
  std::array<PointMoments, NearPoints::kMost> moments;

  CutPoints(const NearPoints& points, std::size_t count_) : FramedPoints(points, count_) {
    for (std::size_t i = 0; i < count; ++i) {
      moments[i] = {1.0,         x[i],        y[i],        z[i],        x[i] * x[i],
                    x[i] * y[i], y[i] * y[i], x[i] * z[i], y[i] * z[i], z[i] * z[i]};
    }
  }
};

/// The parts that cuts along lines in one direction make; the middle one passes the edge point.
PCEDNET_VECTOR_CLONES
void divide(const CutPoints& points, double across_x, double across_y, Parts& parts) {
  constexpr double kMiddle = 0.5 * static_cast<double>(kCuts + 1);
  const double origin_x = points.origin.x(), origin_y = points.origin.y();
  std::array<std::int32_t, NearPoints::kMost> strip_of;
  for (std::size_t i = 0; i < points.count; ++i) {
    const double away = (points.x[i] - origin_x) * across_x + (points.y[i] - origin_y) * across_y;
    strip_of[i] = static_cast<std::int32_t>(smaller(larger(away / kCutStep + kMiddle, 0.0), kCuts));
  }
  std::array<PointMoments, kCuts + 1> strips{};
  for (std::size_t i = 0; i < points.count; ++i) {
    strips[static_cast<std::size_t>(strip_of[i])] += points.moments[i];
  }
  PointMoments before, after;
  for (const PointMoments& strip : strips) after += strip;
  for (std::size_t cut = 0; cut < kCuts; ++cut) {
    before += strips[cut];
    after -= strips[cut];
    parts.set(cut, before);
    parts.set(kCuts + cut, after);
  }
}

struct BestCut {
  std::optional<HalfPlanes> halves;
  double error = std::numeric_limits<double>::infinity();
  int direction = 0;
};

/// Looks for a better cut along lines in one direction.
void try_direction(const CutPoints& points, int direction, BestCut& best) {
  const double angle = std::numbers::pi * direction / kDirections;
  Parts parts;
  divide(points, std::cos(angle), std::sin(angle), parts);
  fit_planes(parts);
  const Frame& frame = points.frame;
  for (std::size_t a = 0, b = kCuts; a < kCuts; ++a, ++b) {
    const double error = parts.error[a] + parts.error[b];
    if (!(error < (1.0 - kByRounding) * best.error)) continue;
    const auto halves = half_planes(parts.plane(a, frame), parts.plane(b, frame),
                                    frame.place(parts.mean(a)), frame.place(parts.mean(b)));
    if (halves) best = {halves, error, direction};
  }
}

/// The half-planes of the two parts with the least error: of every other direction, and of those
/// beside the best of them.
std::optional<HalfPlanes> best_cut(const CutPoints& points) {
  BestCut best;
  for (int i = 0; i < kDirections; i += 2) try_direction(points, i, best);
  const int middle = best.direction;
  try_direction(points, (middle + 1) % kDirections, best);
  try_direction(points, (middle + kDirections - 1) % kDirections, best);
  return best.halves;
}

/// Squared distances of the points to a half-plane: beyond the line, to that.
PCEDNET_VECTOR_CLONES
void sq_distances(const LocalPlane& plane, const Vec3& side, const Wedge& wedge,
                  const NearPoints& points, std::size_t count, NearPoints::Row& result) {
  const double x = wedge.at.x(), y = wedge.at.y(), z = wedge.at.z();
  const double normal_x = plane.normal.x(), normal_y = plane.normal.y(),
               normal_z = plane.normal.z(), distance = plane.distance;
  const double side_x = side.x(), side_y = side.y(), side_z = side.z();
  const double along_x = wedge.along.x(), along_y = wedge.along.y(), along_z = wedge.along.z();
  for (std::size_t i = 0; i < count; ++i) {
    const double px = points.x[i], py = points.y[i], pz = points.z[i];
    const double height = normal_x * px + normal_y * py + normal_z * pz - distance;
    const double dx = px - x, dy = py - y, dz = pz - z;
    const double along = dx * along_x + dy * along_y + dz * along_z;
    const double ax = dx - along * along_x, ay = dy - along * along_y, az = dz - along * along_z;
    const double to_line = ax * ax + ay * ay + az * az;
    const double inside = dx * side_x + dy * side_y + dz * side_z;
    result[i] = inside >= 0.0 ? height * height : to_line;
  }
}

/// The same to the half-planes.
struct SqDistances {
  NearPoints::Row a, b;

  SqDistances(const HalfPlanes& halves, const NearPoints& points, std::size_t count) {
    sq_distances(halves.a, halves.wedge.side_a, halves.wedge, points, count, a);
    sq_distances(halves.b, halves.wedge.side_b, halves.wedge, points, count, b);
  }
};

/// The weights of the points in the fits of the half-planes that they are nearest to; they fall to
/// 0 at `reach`.
PCEDNET_VECTOR_CLONES
void weigh(const SqDistances& to, std::size_t count, double reach, NearPoints::Row& a,
           NearPoints::Row& b) {
  const double per_sq_reach = 1.0 / (reach * reach);
  for (std::size_t i = 0; i < count; ++i) {
    const double rest = larger(1.0 - smaller(to.a[i], to.b[i]) * per_sq_reach, 0.0);
    const bool is_a = to.a[i] < to.b[i];
    a[i] = is_a ? rest * rest : 0.0;
    b[i] = is_a ? 0.0 : rest * rest;
  }
}

std::optional<HalfPlanes> improved(const HalfPlanes& halves, const NearPoints& points,
                                   std::size_t count, double reach) {
  NearPoints::Row weights_a{}, weights_b{};
  weigh(SqDistances(halves, points, count), count, reach, weights_a, weights_b);
  const PointMoments a = points.moments(weights_a), b = points.moments(weights_b);
  constexpr double kWeight = 4.0, kWidth = 0.15;
  const auto plane_a = plane_of(a, kWeight, kWidth);
  const auto plane_b = plane_of(b, kWeight, kWidth);
  if (!plane_a || !plane_b) return std::nullopt;
  return half_planes(*plane_a, *plane_b, a.mean(), b.mean());
}

/// The points near each half-plane, and the sum of squared distances, each at most that of an
/// outlier.
struct Explained {
  std::array<int, 2> on;
  double error;
};

Explained explained_by(const SqDistances& to, std::size_t count, double sq_outlier) {
  Explained result{};
  for (std::size_t i = 0; i < count; ++i) {
    const double nearest = smaller(to.a[i], to.b[i]);
    result.error += smaller(nearest, sq_outlier);
    const int on = nearest <= sq_outlier ? 1 : 0, a = to.a[i] < to.b[i] ? on : 0;
    result.on[0] += a, result.on[1] += on - a;
  }
  return result;
}

/// Whether the half-planes explain the points, and better than a smooth surface.
bool explain(const HalfPlanes& halves, const NearPoints& points, const FramedPoints& framed,
             double noise) {
  const double sq_outlier = std::pow(kOutlier * noise, 2), sq_noise = noise * noise;
  const std::size_t count = framed.count;
  const SqDistances to(halves, points, count);
  const Explained explained = explained_by(to, count, sq_outlier);
  const auto [on_a, on_b] = explained.on;
  const double all = static_cast<double>(count);
  return std::min(on_a, on_b) >= kFewestOfSide && all - on_a - on_b <= kMostOutliers * all &&
         explained.error <= kMostMeanSquare * sq_noise * all &&
         explained.error + kPrice * sq_noise <= error_of_quadric(framed, sq_outlier);
}

}  // namespace

bool is_smooth(const NearPoints& points, const Wedge& wedge, double noise) {
  const FramedPoints framed(points, points.count);
  const double quadric = error_of_quadric(framed, kSqOutlierOfSmooth);
  const auto plane = [&](const Vec3& side) {
    const Vec3 normal = wedge.along.cross(side);
    return LocalPlane{normal, normal.dot(wedge.at), 0};
  };
  const HalfPlanes halves = {plane(wedge.side_a), plane(wedge.side_b), wedge};
  const SqDistances to(halves, points, points.count);
  const double planes = explained_by(to, points.count, kSqOutlierOfSmooth).error;
  return quadric < kShareOfSmooth * planes &&
         quadric < std::pow(noise + kBeyondNoise, 2) * static_cast<double>(points.count);
}

std::optional<Wedge> fit_half_planes(const NearPoints& points, std::size_t count, double noise) {
  count = std::min(count, points.count);
  if (count < kFewestPoints) return std::nullopt;
  const CutPoints framed(points, count);
  auto halves = best_cut(framed);
  for (int i = 0; i < kImprovements && halves; ++i) {
    halves = improved(*halves, points, count, kOutlier * noise);
  }
  if (!halves || halves->wedge.at.norm() > kFromPoint) return std::nullopt;
  if (!explain(*halves, points, framed, noise)) return std::nullopt;
  return halves->wedge;
}

}  // namespace pcednet::lines
