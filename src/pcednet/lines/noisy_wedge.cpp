#include "pcednet/lines/noisy_wedge.h"

#include <Eigen/Dense>
#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <limits>
#include <numbers>
#include <numeric>

#include "pcednet/core/eigendecomposition.h"
#include "pcednet/core/half_space.h"
#include "pcednet/core/vector_clones.h"
#include "pcednet/lines/lanes.h"
#include "pcednet/lines/plane_line.h"

namespace pcednet::lines {
namespace {

constexpr std::size_t kFewestPoints = 14;
constexpr int kFewestOfSide = 5;
constexpr double kSmallestAngle = 22.0 * std::numbers::pi / 180.0;
constexpr int kDirections = 10;   ///< even
constexpr std::size_t kCuts = 9;  ///< of each direction
constexpr int kImprovements = 3;
constexpr double kMostOutliers = 0.12;   ///< share of the points
constexpr double kPrice = 2.0;           ///< in squared standard deviations: of the choice of a cut
constexpr double kMostMeanSquare = 1.7;  ///< of the distances, in squared standard deviations

// In spacings.
constexpr double kCutStep = 0.5;    ///< from one cut to the next
constexpr double kFromPoint = 2.2;  ///< of the line from the origin

// In standard deviations.
constexpr double kOutlier = 3.0;

/// Least squares heights are fitted in it: z is across the points, the origin their mean.
struct Frame {
  Vec3 origin, x, y, z;

  Vec3 of(const Vec3& place) const {
    const Vec3 offset = place - origin;
    return {offset.dot(x), offset.dot(y), offset.dot(z)};
  }
  Vec3 place(const Vec3& local) const {
    return origin + local.x() * x + local.y() * y + local.z() * z;
  }
};

Frame frame_of(const NearPoints& points, std::size_t count) {
  NearPoints::Row weights{};
  std::fill_n(weights.begin(), count, 1.0);
  const PointMoments moments = points.moments(weights);
  const Mat3 axes = eigendecomposition(moments.covariance()).vectors;
  const Vec3 z = axes.col(0).normalized();
  const Vec3 x = axes.col(2).normalized();
  return {moments.mean(), x, z.cross(x), z};
}

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

/// The points in their frame.
struct FramedPoints {
  Frame frame;
  Vec3 origin;  ///< the edge point
  std::size_t count;
  NearPoints::Row x{}, y{}, z{};
  std::array<PointMoments, NearPoints::kMost> moments;

  FramedPoints(const NearPoints& points, std::size_t count_)
      : frame(frame_of(points, count_)), origin(frame.of(Vec3::Zero())), count(count_) {
    project(points, frame.x, x);
    project(points, frame.y, y);
    project(points, frame.z, z);
    for (std::size_t i = 0; i < count; ++i) {
      moments[i] = {1.0,         x[i],        y[i],        z[i],        x[i] * x[i],
                    x[i] * y[i], y[i] * y[i], x[i] * z[i], y[i] * z[i], z[i] * z[i]};
    }
  }

 private:
  void project(const NearPoints& points, const Vec3& axis, NearPoints::Row& row) const;
};

PCEDNET_VECTOR_CLONES
void FramedPoints::project(const NearPoints& points, const Vec3& axis, NearPoints::Row& row) const {
  const double axis_x = axis.x(), axis_y = axis.y(), axis_z = axis.z();
  const double from_x = frame.origin.x(), from_y = frame.origin.y(), from_z = frame.origin.z();
  for (std::size_t i = 0; i < count; ++i) {
    row[i] = (points.x[i] - from_x) * axis_x + (points.y[i] - from_y) * axis_y +
             (points.z[i] - from_z) * axis_z;
  }
}

/// The parts that cuts along lines in one direction make; the middle one passes the edge point.
PCEDNET_VECTOR_CLONES
void divide(const FramedPoints& points, double across_x, double across_y, Parts& parts) {
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
void try_direction(const FramedPoints& points, int direction, BestCut& best) {
  const double angle = std::numbers::pi * direction / kDirections;
  Parts parts;
  divide(points, std::cos(angle), std::sin(angle), parts);
  fit_planes(parts);
  const Frame& frame = points.frame;
  for (std::size_t a = 0, b = kCuts; a < kCuts; ++a, ++b) {
    const double error = parts.error[a] + parts.error[b];
    if (!(error < best.error)) continue;
    const auto halves = half_planes(parts.plane(a, frame), parts.plane(b, frame),
                                    frame.place(parts.mean(a)), frame.place(parts.mean(b)));
    if (halves) best = {halves, error, direction};
  }
}

/// The half-planes of the two parts with the least error: of every other direction, and of those
/// beside the best of them.
std::optional<HalfPlanes> best_cut(const FramedPoints& points) {
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

/// Sums over places: of x^i y^j with i + j <= 4 in the order 1, x, y, xx, xy, yy, xxx ..., and of z
/// with each of the first six.
struct QuadricSums {
  std::array<double, 15> xy;
  std::array<double, 6> z;
};

PCEDNET_VECTOR_CLONES
void add_up(const FramedPoints& points, const NearPoints::Row& ones, QuadricSums& result) {
  Lanes xy[15] = {}, of_z[6] = {};
  for (std::size_t i = 0; i < points.count; i += kLanes) {
    Lanes x, y, z, one;
    load(&points.x[i], x);
    load(&points.y[i], y);
    load(&points.z[i], z);
    load(&ones[i], one);
    const Lanes xx = x * x, xy1 = x * y, yy = y * y;
    const Lanes terms[15] = {one,    x,      y,       xx,       xy1,     yy,       xx * x, xx * y,
                             yy * x, yy * y, xx * xx, xx * xy1, xx * yy, xy1 * yy, yy * yy};
    for (int k = 0; k < 15; ++k) xy[k] += terms[k];
    for (int k = 0; k < 6; ++k) of_z[k] += terms[k] * z;
  }
  for (std::size_t k = 0; k < 15; ++k) result.xy[k] = sum_of(xy[k]);
  for (std::size_t k = 0; k < 6; ++k) result.z[k] = sum_of(of_z[k]);
}

/// The squared distances of points to the surface z = c0 + c1 x + c2 y + c3 x^2 + c4 x y + c5 y^2,
/// to first order, each at most `sq_most`.
PCEDNET_VECTOR_CLONES
void sq_distances_to_quadric(const FramedPoints& points, const double* c, double sq_most,
                             NearPoints::Row& result) {
  const double c0 = c[0], c1 = c[1], c2 = c[2], c3 = c[3], c4 = c[4], c5 = c[5];
  for (std::size_t i = 0; i < points.count; ++i) {
    const double x = points.x[i], y = points.y[i];
    const double away = points.z[i] - (c0 + c1 * x + c2 * y + c3 * x * x + c4 * x * y + c5 * y * y);
    const double slope_x = c1 + 2.0 * c3 * x + c4 * y, slope_y = c2 + c4 * x + 2.0 * c5 * y;
    result[i] = smaller(away * away / (1.0 + slope_x * slope_x + slope_y * slope_y), sq_most);
  }
}

/// Sum of squared distances to the best quadratic height, each at most that of an outlier.
double error_of_quadric(const FramedPoints& points, double sq_outlier) {
  constexpr std::size_t kPowers[6][2] = {{0, 0}, {1, 0}, {0, 1}, {2, 0}, {1, 1}, {0, 2}};
  NearPoints::Row row{};
  std::fill_n(row.begin(), points.count, 1.0);
  QuadricSums sums;
  add_up(points, row, sums);
  Eigen::Matrix<double, 6, 6> left;
  Eigen::Matrix<double, 6, 1> right;
  for (Eigen::Index a = 0; a < 6; ++a) {
    for (Eigen::Index b = 0; b <= a; ++b) {
      const std::size_t of_y = kPowers[a][1] + kPowers[b][1];
      const std::size_t all = kPowers[a][0] + kPowers[b][0] + of_y;
      left(a, b) = sums.xy[all * (all + 1) / 2 + of_y];
    }
    right[a] = sums.z[static_cast<std::size_t>(a)];
  }
  const Eigen::Matrix<double, 6, 1> c = left.ldlt().solve(right);  // reads the lower half
  sq_distances_to_quadric(points, c.data(), sq_outlier, row);
  return std::accumulate(row.begin(), row.begin() + points.count, 0.0);
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

std::optional<Wedge> fit_half_planes(const NearPoints& points, std::size_t count, double noise) {
  count = std::min(count, points.count);
  if (count < kFewestPoints) return std::nullopt;
  const FramedPoints framed(points, count);
  auto halves = best_cut(framed);
  for (int i = 0; i < kImprovements && halves; ++i) {
    halves = improved(*halves, points, count, kOutlier * noise);
  }
  if (!halves || halves->wedge.at.norm() > kFromPoint) return std::nullopt;
  if (!explain(*halves, points, framed, noise)) return std::nullopt;
  return halves->wedge;
}

}  // namespace pcednet::lines
