#include "pcednet/lines/noisy_wedge.h"

#include <Eigen/Dense>
#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <numbers>
#include <span>

#include "pcednet/core/eigendecomposition.h"
#include "pcednet/core/half_space.h"

namespace pcednet::lines {
namespace {

constexpr std::size_t kFewestPoints = 14;
constexpr int kFewestOfSide = 5;
constexpr double kSmallestAngle = 22.0 * std::numbers::pi / 180.0;
constexpr int kDirections = 10;
constexpr std::size_t kCuts = 9;  ///< of each direction
constexpr int kImprovements = 4;
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
  Moments moments;
  for (std::size_t i = 0; i < count; ++i) moments.add(points.offset(i));
  const Mat3 axes = eigendecomposition(moments.covariance()).vectors;
  const Vec3 z = axes.col(0).normalized();
  const Vec3 x = axes.col(2).normalized();
  return {moments.mean(), x, z.cross(x), z};
}

/// Sums over points (u, v, h) for heights h that are linear in u and v.
struct HeightSums {
  double n = 0.0, u = 0.0, v = 0.0, uu = 0.0, uv = 0.0, vv = 0.0;
  double h = 0.0, hu = 0.0, hv = 0.0, hh = 0.0;

  HeightSums() = default;
  explicit HeightSums(const Vec3& p)
      : n(1.0),
        u(p.x()),
        v(p.y()),
        uu(p.x() * p.x()),
        uv(p.x() * p.y()),
        vv(p.y() * p.y()),
        h(p.z()),
        hu(p.z() * p.x()),
        hv(p.z() * p.y()),
        hh(p.z() * p.z()) {}

  void add(const HeightSums& other, double sign = 1.0) {
    n += sign * other.n;
    u += sign * other.u;
    v += sign * other.v;
    uu += sign * other.uu;
    uv += sign * other.uv;
    vv += sign * other.vv;
    h += sign * other.h;
    hu += sign * other.hu;
    hv += sign * other.hv;
    hh += sign * other.hh;
  }
  Vec3 mean() const { return Vec3(u, v, h) / n; }
};

/// The least-squares plane of a part, by its slopes in the frame.
struct Part {
  Vec3 mean;
  double slope_u, slope_v;
  double error;  ///< sum of squared distances across the plane
};

std::optional<Part> part_of(const HeightSums& sums) {
  constexpr double kLeastSpread = 0.02;  // of the points of a part over u and v
  if (sums.n < static_cast<double>(kFewestOfSide)) return std::nullopt;
  const Vec3 mean = sums.mean();
  const double uu = sums.uu - sums.u * mean.x(), uv = sums.uv - sums.u * mean.y();
  const double vv = sums.vv - sums.v * mean.y(), hh = sums.hh - sums.h * mean.z();
  const double hu = sums.hu - sums.h * mean.x(), hv = sums.hv - sums.h * mean.y();
  const double determinant = uu * vv - uv * uv;
  if (!(determinant > kLeastSpread * sums.n * sums.n)) return std::nullopt;
  const double slope_u = (hu * vv - hv * uv) / determinant;
  const double slope_v = (hv * uu - hu * uv) / determinant;
  const double error = std::max(0.0, hh - slope_u * hu - slope_v * hv) /
                       (1.0 + slope_u * slope_u + slope_v * slope_v);
  return Part{mean, slope_u, slope_v, error};
}

LocalPlane plane_of(const Part& part, const Frame& frame) {
  const Vec3 normal = (frame.z - part.slope_u * frame.x - part.slope_v * frame.y).normalized();
  return {normal, normal.dot(frame.place(part.mean)), 0};
}

/// The half-planes of two planes, each on the side of a point of its part.
std::optional<HalfPlanes> half_planes(const LocalPlane& a, const LocalPlane& b, const Vec3& of_a,
                                      const Vec3& of_b) {
  const double cosine = a.normal.dot(b.normal), sq_sine = 1.0 - cosine * cosine;
  if (sq_sine < std::pow(std::sin(kSmallestAngle), 2)) return std::nullopt;
  HalfPlanes halves{.a = a, .b = b, .at = {}, .along = {}, .side_a = {}, .side_b = {}};
  halves.at = ((a.distance - cosine * b.distance) * a.normal +
               (b.distance - cosine * a.distance) * b.normal) /
              sq_sine;
  halves.along = a.normal.cross(b.normal).normalized();
  const auto towards = [&](const Vec3& normal, const Vec3& place) {
    const Vec3 side = halves.along.cross(normal);
    return turned_to(side, place - halves.at);
  };
  halves.side_a = towards(a.normal, of_a);
  halves.side_b = towards(b.normal, of_b);
  return halves;
}

/// The best of the cuts along lines that pass the origin in one direction.
void try_cuts(std::span<const HeightSums> places, const Frame& frame, double angle,
              std::optional<HalfPlanes>& best, double& least_error) {
  const Vec3 origin = frame.of(Vec3::Zero());
  const double across_u = std::cos(angle), across_v = std::sin(angle);
  constexpr double kMiddle = 0.5 * static_cast<double>(kCuts + 1);
  std::array<HeightSums, kCuts + 1> strips{};
  HeightSums before, after;
  for (const HeightSums& place : places) {
    const double away = (place.u - origin.x()) * across_u + (place.v - origin.y()) * across_v;
    const double strip = away / kCutStep + kMiddle;
    strips[static_cast<std::size_t>(std::clamp(strip, 0.0, static_cast<double>(kCuts)))].add(place);
  }
  for (const HeightSums& strip : strips) after.add(strip);
  for (std::size_t cut = 0; cut < kCuts; ++cut) {
    before.add(strips[cut]);
    after.add(strips[cut], -1.0);
    const auto a = part_of(before);
    if (!a || a->error >= least_error) continue;
    const auto b = part_of(after);
    if (!b || a->error + b->error >= least_error) continue;
    const auto halves = half_planes(plane_of(*a, frame), plane_of(*b, frame), frame.place(a->mean),
                                    frame.place(b->mean));
    if (!halves) continue;
    least_error = a->error + b->error;
    best = halves;
  }
}

std::optional<HalfPlanes> best_cut(const NearPoints& points, std::size_t count,
                                   const Frame& frame) {
  std::array<HeightSums, NearPoints::kMost> places;
  for (std::size_t i = 0; i < count; ++i) places[i] = HeightSums(frame.of(points.offset(i)));
  std::optional<HalfPlanes> best;
  double least_error = std::numeric_limits<double>::infinity();
  for (int i = 0; i < kDirections; ++i) {
    const double angle = std::numbers::pi * i / kDirections;
    try_cuts(std::span(places).first(count), frame, angle, best, least_error);
  }
  return best;
}

double sq_distance(const LocalPlane& plane, const Vec3& side, const HalfPlanes& halves,
                   const Vec3& place) {
  const Vec3 offset = place - halves.at;
  if (offset.dot(side) >= 0.0) return std::pow(plane(place), 2);
  return (offset - offset.dot(halves.along) * halves.along).squaredNorm();
}

struct Nearer {
  double sq_distance;
  bool is_a;
};

Nearer nearer(const HalfPlanes& halves, const Vec3& place) {
  const double a = sq_distance(halves.a, halves.side_a, halves, place);
  const double b = sq_distance(halves.b, halves.side_b, halves, place);
  return {std::min(a, b), a < b};
}

std::optional<HalfPlanes> improved(const HalfPlanes& halves, const NearPoints& points,
                                   std::size_t count, double reach) {
  Moments a, b;
  for (std::size_t i = 0; i < count; ++i) {
    const auto [sq_distance, is_a] = nearer(halves, points.offset(i));
    const double part = sq_distance / (reach * reach);
    if (part < 1.0) (is_a ? a : b).add(points.offset(i), (1.0 - part) * (1.0 - part));
  }
  constexpr double kWeight = 4.0, kWidth = 0.15;
  const auto plane_a = plane_of(a, kWeight, kWidth);
  const auto plane_b = plane_of(b, kWeight, kWidth);
  if (!plane_a || !plane_b) return std::nullopt;
  return half_planes(*plane_a, *plane_b, a.mean(), b.mean());
}

/// Sum of squared distances to the best quadratic height, each at most that of an outlier.
double error_of_quadric(const NearPoints& points, std::size_t count, const Frame& frame,
                        double noise) {
  using Row = Eigen::Matrix<double, 6, 1>;
  const auto row_of = [](const Vec3& p) {
    Row row;
    row << 1.0, p.x(), p.y(), p.x() * p.x(), p.x() * p.y(), p.y() * p.y();
    return row;
  };
  Eigen::Matrix<double, 6, 6> left = Eigen::Matrix<double, 6, 6>::Zero();
  Row right = Row::Zero();
  for (std::size_t i = 0; i < count; ++i) {
    const Vec3 p = frame.of(points.offset(i));
    const Row row = row_of(p);
    left += row * row.transpose();
    right += p.z() * row;
  }
  const Row c = left.ldlt().solve(right);
  double error = 0.0;
  for (std::size_t i = 0; i < count; ++i) {
    const Vec3 p = frame.of(points.offset(i));
    const double away = p.z() - row_of(p).dot(c);
    const double slope_u = c[1] + 2.0 * c[3] * p.x() + c[4] * p.y();
    const double slope_v = c[2] + c[4] * p.x() + 2.0 * c[5] * p.y();
    error += std::min(std::pow(kOutlier * noise, 2),
                      away * away / (1.0 + slope_u * slope_u + slope_v * slope_v));
  }
  return error;
}

/// Whether the half-planes explain the points, and better than a smooth surface.
bool explain(const HalfPlanes& halves, const NearPoints& points, std::size_t count,
             const Frame& frame, double noise) {
  const double sq_outlier = std::pow(kOutlier * noise, 2), sq_noise = noise * noise;
  double error = 0.0;
  int on_a = 0, on_b = 0;
  for (std::size_t i = 0; i < count; ++i) {
    const auto [sq_distance, is_a] = nearer(halves, points.offset(i));
    error += std::min(sq_distance, sq_outlier);
    if (sq_distance <= sq_outlier) ++(is_a ? on_a : on_b);
  }
  const double all = static_cast<double>(count);
  return std::min(on_a, on_b) >= kFewestOfSide && all - on_a - on_b <= kMostOutliers * all &&
         error <= kMostMeanSquare * sq_noise * all &&
         error + kPrice * sq_noise <= error_of_quadric(points, count, frame, noise);
}

}  // namespace

std::optional<HalfPlanes> fit_half_planes(const NearPoints& points, std::size_t count,
                                          double noise) {
  count = std::min(count, points.count);
  if (count < kFewestPoints) return std::nullopt;
  const Frame frame = frame_of(points, count);
  auto halves = best_cut(points, count, frame);
  for (int i = 0; i < kImprovements && halves; ++i) {
    halves = improved(*halves, points, count, kOutlier * noise);
  }
  if (!halves || halves->at.norm() > kFromPoint) return std::nullopt;
  if (!explain(*halves, points, count, frame, noise)) return std::nullopt;
  return halves;
}

}  // namespace pcednet::lines
