#include "pcednet/lines/creases/quadric.h"

#include <Eigen/Dense>
#include <algorithm>
#include <array>
#include <numeric>

#include "pcednet/core/eigendecomposition.h"
#include "pcednet/core/vector_clones.h"
#include "pcednet/lines/points/lanes.h"
#include "pcednet/lines/points/moments.h"

namespace pcednet::lines {
namespace {

Frame frame_of(const NearPoints& points, std::size_t count) {
  NearPoints::Row weights{};
  std::fill_n(weights.begin(), count, 1.0);
  const PointMoments moments = points.moments(weights);
  const Mat3 axes = eigendecomposition(moments.covariance()).vectors;
  const Vec3 z = axes.col(0).normalized();
  const Vec3 x = axes.col(2).normalized();
  return {moments.mean(), x, z.cross(x), z};
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

}  // namespace

FramedPoints::FramedPoints(const NearPoints& points, std::size_t count_)
    : frame(frame_of(points, count_)), origin(frame.of(Vec3::Zero())), count(count_) {
  project(points, frame.x, x);
  project(points, frame.y, y);
  project(points, frame.z, z);
}

PCEDNET_VECTOR_CLONES
void FramedPoints::project(const NearPoints& points, const Vec3& axis, NearPoints::Row& row) const {
  const double axis_x = axis.x(), axis_y = axis.y(), axis_z = axis.z();
  const double from_x = frame.origin.x(), from_y = frame.origin.y(), from_z = frame.origin.z();
  for (std::size_t i = 0; i < count; ++i) {
    row[i] = (points.x[i] - from_x) * axis_x + (points.y[i] - from_y) * axis_y +
             (points.z[i] - from_z) * axis_z;
  }
}

double error_of_quadric(const FramedPoints& points, double sq_most) {
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
  sq_distances_to_quadric(points, c.data(), sq_most, row);
  return std::accumulate(row.begin(), row.begin() + points.count, 0.0);
}

}  // namespace pcednet::lines
