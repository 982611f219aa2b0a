#include "pcednet/normals/plane_fit.h"

#include <Eigen/Eigenvalues>
#include <algorithm>

namespace pcednet::normals {
namespace {

/// Second eigenvalue over the largest below which a neighbourhood is taken for a line: a width of
/// 1e-5 of the length.
constexpr double kLine = 1e-10;

/// Compares sums of products of eigenvalues, which have no rounding error to speak of where the
/// eigenvalues themselves, from the closed form, are good to 1e-8 of the largest only.
bool is_line(const Mat3& c) {
  const double pairs = c(0, 0) * c(1, 1) - c(0, 1) * c(0, 1) + c(0, 0) * c(2, 2) -
                       c(0, 2) * c(0, 2) + c(1, 1) * c(2, 2) - c(1, 2) * c(1, 2);
  return !(pairs > kLine * c.trace() * c.trace());
}

}  // namespace

PlaneFit fit_plane(std::span<const Vec3> points, std::size_t point,
                   std::span<const std::uint32_t> neighbours) {
  if (neighbours.size() < 2) return {};
  // Offsets from the point, not positions: nothing is lost far from the origin.
  const Vec3 centre = points[point];
  const double sq_radius = 1.05 * (points[neighbours.back()] - centre).squaredNorm();
  double sum_weights = 1.0;
  Vec3 sum = Vec3::Zero();
  double xx = 0.0, xy = 0.0, xz = 0.0, yy = 0.0, yz = 0.0, zz = 0.0;
  for (const std::uint32_t j : neighbours) {
    const Vec3 offset = points[j] - centre;
    const double falloff = 1.0 - offset.squaredNorm() / sq_radius;
    const double weight = falloff * falloff;
    const Vec3 weighted = weight * offset;
    sum_weights += weight;
    sum += weighted;
    xx += weighted.x() * offset.x(), xy += weighted.y() * offset.x();
    xz += weighted.z() * offset.x(), yy += weighted.y() * offset.y();
    yz += weighted.z() * offset.y(), zz += weighted.z() * offset.z();
  }
  Mat3 products;
  products << xx, xy, xz, xy, yy, yz, xz, yz, zz;
  const Mat3 covariance = products - sum * sum.transpose() / sum_weights;
  if (is_line(covariance)) return {};
  Eigen::SelfAdjointEigenSolver<Mat3> solver;
  solver.computeDirect(covariance);
  const Vec3 eigenvalues = solver.eigenvalues().cwiseMax(0.0);
  return {solver.eigenvectors().col(0).normalized(), eigenvalues[0] / eigenvalues[1]};
}

}  // namespace pcednet::normals
