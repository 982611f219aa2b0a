#include "pcednet/gls/descriptor.h"

#include <algorithm>
#include <cmath>

#include "pcednet/core/half_space.h"

namespace pcednet::gls {
namespace {

/// The part of `v` orthogonal to the unit vector `eta`.
Vec3 tangential(const Vec3& v, const Vec3& eta) {
  return v - eta * eta.dot(v);
}

}  // namespace

Descriptor describe_sphere(const SphereFit& fit, const MomentSet& moments) {
  Descriptor result;
  if (fit.status == FitStatus::kUndefined) return result;
  const AlgebraicSphere& u = fit.sphere;
  const double length = u.ul.norm();
  const double sq_pratt = u.pratt * u.pratt, cube_pratt = sq_pratt * u.pratt;
  result.tau = u.uc / u.pratt;
  result.eta = u.ul / length;
  result.kappa = 2.0 * u.uq / u.pratt;
  // Outside [0, 1] only by rounding: pratt^2 = |N/W|^2 + A^2/(B W), and the normals are unit.
  result.phi = std::clamp(1.0 - sq_pratt, 0.0, 1.0);

  const auto dtau = [&](const SphereDerivative& du, double ds) {
    return ds / u.pratt - u.uc * du.sq_pratt / (2.0 * cube_pratt);
  };
  const auto dkappa = [&](const SphereDerivative& du) {
    return 2.0 * du.uq / u.pratt - u.uq * du.sq_pratt / cube_pratt;
  };

  const SphereDerivative dt = differentiate(fit, moments.value, moments.dt);
  result.dtau_dt = dtau(dt, dt.uc);
  result.dkappa_dt = dkappa(dt);
  result.deta_dt = tangential(dt.ul, result.eta) / length;

  for (int k = 0; k < 3; ++k) {
    const SphereDerivative dx =
        differentiate(fit, moments.value, moments.dx[static_cast<std::size_t>(k)]);
    const Vec3 dgradient = dx.ul + 2.0 * u.uq * Vec3::Unit(k);
    result.dtau_dx[k] = dtau(dx, dx.uc + u.ul[k]);
    result.dkappa_dx[k] = dkappa(dx);
    result.deta_dx.col(k) = tangential(dgradient, result.eta) / length;
  }
  const auto [k1, k2] = principal_curvatures(result.deta_dx, result.eta, result.kappa);
  result.k1 = k1;
  result.k2 = k2;
  return result;
}

PrincipalCurvatures principal_curvatures(const Mat3& deta_dx, const Vec3& eta, double tie) {
  // An orthonormal basis of the tangent plane without a square root and stable everywhere (Duff et
  // al. 2017), the same for eta and -eta.
  const Vec3 up = upward(eta);
  const double a = -1.0 / (1.0 + up.z());
  const double b = up.x() * up.y() * a;
  const Vec3 b1(1.0 + up.x() * up.x() * a, b, -up.x());
  const Vec3 b2(b, 1.0 + up.y() * up.y() * a, -up.y());

  const Vec3 d1 = deta_dx * b1, d2 = deta_dx * b2;
  const double m11 = b1.dot(d1), m22 = b2.dot(d2), m12 = 0.5 * (b1.dot(d2) + b2.dot(d1));
  const double mean = 0.5 * (m11 + m22);
  const double spread = std::hypot(0.5 * (m11 - m22), m12);
  const double side = mean != 0.0 ? mean : tie;
  return side < 0.0 ? PrincipalCurvatures{mean - spread, mean + spread}
                    : PrincipalCurvatures{mean + spread, mean - spread};
}

}  // namespace pcednet::gls
