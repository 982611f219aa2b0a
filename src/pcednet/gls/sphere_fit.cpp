#include "pcednet/gls/sphere_fit.h"

#include <cmath>

#include "pcednet/gls/fit_limits.h"

namespace pcednet::gls {

SphereFit fit_sphere(const Moments& m, std::uint32_t count, double t) {
  SphereFit fit;
  if (status_of_count(count) == FitStatus::kUndefined || !(m.w > 0.0)) return fit;
  fit.a = m.pn - m.p.dot(m.n) / m.w;
  fit.b = m.pp - m.p.squaredNorm() / m.w;
  if (fit.b <= kSmallestSqSpread * t * t * m.w) fit.a = fit.b = 0.0;

  AlgebraicSphere& u = fit.sphere;
  u.uq = fit.b > 0.0 ? fit.a / (2.0 * fit.b) : 0.0;
  u.ul = (m.n - 2.0 * u.uq * m.p) / m.w;
  u.uc = -(u.ul.dot(m.p) + u.uq * m.pp) / m.w;
  const double sq_pratt = u.ul.squaredNorm() - 4.0 * u.uc * u.uq;
  constexpr double kSmallestSquare = kSmallestLength * kSmallestLength;
  if (!(sq_pratt > kSmallestSquare) || !(u.ul.squaredNorm() > kSmallestSquare)) return fit;
  u.pratt = std::sqrt(sq_pratt);
  fit.status = status_of_count(count);
  return fit;
}

SphereDerivative differentiate(const SphereFit& fit, const Moments& m, const Moments& d) {
  const AlgebraicSphere& u = fit.sphere;
  SphereDerivative du;
  if (fit.b > 0.0) {
    const double sq_w = m.w * m.w;
    const double da = d.pn - (m.n.dot(d.p) + m.p.dot(d.n)) / m.w + m.p.dot(m.n) * d.w / sq_w;
    const double db = d.pp - 2.0 * m.p.dot(d.p) / m.w + m.p.squaredNorm() * d.w / sq_w;
    du.uq = (da - db * (fit.a / fit.b)) / (2.0 * fit.b);
  }
  du.ul = (d.n - u.ul * d.w - 2.0 * (u.uq * d.p + m.p * du.uq)) / m.w;
  du.uc = -(m.p.dot(du.ul) + u.ul.dot(d.p) + m.pp * du.uq + u.uq * d.pp + u.uc * d.w) / m.w;
  du.sq_pratt = 2.0 * u.ul.dot(du.ul) - 4.0 * (u.uq * du.uc + u.uc * du.uq);
  return du;
}

}  // namespace pcednet::gls
