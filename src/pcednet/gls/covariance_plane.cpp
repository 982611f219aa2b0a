#include "pcednet/gls/covariance_plane.h"

#include <Eigen/Eigenvalues>
#include <algorithm>
#include <array>

#include "pcednet/gls/kernel.h"

namespace pcednet::gls {
namespace {

/// As Moments, with second moments of position in place of those that need the normals.
struct PlaneMoments {
  double w = 0.0;          ///< S w
  Vec3 p = Vec3::Zero();   ///< S w y
  Mat3 pp = Mat3::Zero();  ///< S w y y^T
};

struct PlaneMomentSet {
  PlaneMoments value, dt;
  std::array<PlaneMoments, 3> dx;
  Vec3 n = Vec3::Zero();  ///< S w n
};

PlaneMomentSet sum_plane_moments(std::span<const LocalNeighbour> neighbours, double t) {
  const Kernel kernel(t);
  PlaneMomentSet set;
  for (const LocalNeighbour& neighbour : neighbours) {
    const Vec3 y = neighbour.y();
    const Mat3 yy = y * y.transpose();
    const auto add = [&](PlaneMoments& moments, double weight) {
      moments.w += weight;
      moments.p += weight * y;
      moments.pp += weight * yy;
    };
    const KernelWeight w = kernel(neighbour.sq_distance());
    add(set.value, neighbour.gate() * w.value);
    add(set.dt, neighbour.gate() * w.dt);
    for (int k = 0; k < 3; ++k) {
      add(set.dx[static_cast<std::size_t>(k)], neighbour.gate() * w.dx * y[k]);
    }
    set.n += neighbour.gate() * w.value * neighbour.n();
  }
  return set;
}

struct PlaneDerivative {
  Vec3 mean;
  Vec3 eta;
};

/// d(mean) = (dP - m dW)/W and, the eigenvectors v_i being orthonormal,
/// d(eta) = -S_i v_i (v_i . dC eta) / (lambda_i - lambda_0) over the two others.
PlaneDerivative differentiate(const PlaneMoments& m, const Mat3& vectors, const Vec3& values,
                              const Vec3& eta, const PlaneMoments& d) {
  const Vec3 mean = m.p / m.w;
  const Mat3 dc =
      d.pp - d.p * mean.transpose() - mean * d.p.transpose() + mean * mean.transpose() * d.w;
  PlaneDerivative result{(d.p - mean * d.w) / m.w, Vec3::Zero()};
  for (int i = 1; i < 3; ++i) {
    const Vec3 v = vectors.col(i);
    result.eta -= v * (v.dot(dc * eta) / (values[i] - values[0]));
  }
  return result;
}

}  // namespace

CovariancePlane fit_covariance_plane(std::span<const LocalNeighbour> neighbours, double t) {
  CovariancePlane fit;
  const auto count = static_cast<std::uint32_t>(neighbours.size());
  if (status_of_count(count) == FitStatus::kUndefined) return fit;
  const PlaneMomentSet set = sum_plane_moments(neighbours, t);
  const PlaneMoments& m = set.value;
  if (!(m.w > 0.0)) return fit;
  const Vec3 mean = m.p / m.w;
  const Mat3 covariance = m.pp - m.p * mean.transpose();
  const Eigen::SelfAdjointEigenSolver<Mat3> solver(covariance);
  const Vec3& values = solver.eigenvalues();
  constexpr double kSmallestGap = 1e-9;
  const bool one_place = !(values[2] > 1e-12 * t * t * m.w);
  if (one_place || !(values[1] - values[0] > kSmallestGap * values[2])) return fit;
  Vec3 eta = solver.eigenvectors().col(0);
  const double side = eta.dot(set.n);
  if (side == 0.0) return fit;
  if (side < 0.0) eta = -eta;

  fit.status = status_of_count(count);
  fit.plane = {-eta.dot(mean), eta, 0.0, 1.0};
  Descriptor& result = fit.descriptor;
  result.tau = fit.plane.uc;
  result.eta = eta;
  result.phi = std::clamp(3.0 * values[0] / values.sum(), 0.0, 1.0);

  const PlaneDerivative dt = differentiate(m, solver.eigenvectors(), values, eta, set.dt);
  result.dtau_dt = -dt.eta.dot(mean) - eta.dot(dt.mean);
  result.deta_dt = dt.eta;
  for (int k = 0; k < 3; ++k) {
    const PlaneDerivative dx =
        differentiate(m, solver.eigenvectors(), values, eta, set.dx[static_cast<std::size_t>(k)]);
    result.dtau_dx[k] = -dx.eta.dot(mean) - eta.dot(dx.mean) + eta[k];
    result.deta_dx.col(k) = dx.eta;
  }
  const auto [k1, k2] = principal_curvatures(result.deta_dx, eta, 1.0);
  result.k1 = k1;
  result.k2 = k2;
  return fit;
}

}  // namespace pcednet::gls
