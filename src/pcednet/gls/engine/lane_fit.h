#pragma once

#include "pcednet/gls/engine/lane_vector.h"
#include "pcednet/gls/fit_limits.h"

/// Computes the sphere of a neighbourhood and its reliability from the sums, a target per lane and
/// in units of the support radius: the equations of sphere_fit.h.
namespace pcednet::gls {
namespace {  // each unit has its own copy, see simd.h

/// The five moments, or their derivative in one direction.
template <int W>
struct LaneMoments {
  Floats<W> w;
  Lanes3<W> p, n;
  Floats<W> pn, pp;
};

template <int W>
struct LaneSphere {
  Floats<W> inverse_w, uq, uc, a, b;  // b: 1 where rounding or equal places leave nothing of it
  Floats<W> spread;                   // what they leave
  Lanes3<W> ul;
};

template <int W>
inline LaneMoments<W> moments_of(const LaneSums& sums, int first) {
  const Floats<W> uyy = load<W>(sums.uyy + first);
  return {load<W>(sums.u + first) - uyy, load3<W>(sums.uy, first) - load3<W>(sums.u_yy_y, first),
          load3<W>(sums.wn, first), load<W>(sums.wyn + first), load<W>(sums.wyy + first)};
}

/// t d/dt of the moments: 4 (S u f - S w f).
template <int W>
inline LaneMoments<W> scale_derivative(const LaneSums& sums, int first, const LaneMoments<W>& m) {
  const Floats<W> four = splat<W>(4.0f);
  return {4.0f * load<W>(sums.uyy + first), four * load3<W>(sums.u_yy_y, first),
          four * (load3<W>(sums.un, first) - m.n), 4.0f * (load<W>(sums.uyn + first) - m.pn),
          4.0f * (load<W>(sums.uyy + first) - m.pp)};
}

/// t d/dx of the moments along the unit vector `v`: 4 S (u y.v) f.
template <int W>
inline LaneMoments<W> spatial_derivative(const LaneSums& sums, int first, const Lanes3<W>& v) {
  const Lanes3<W> v4 = splat<W>(4.0f) * v;
  const Lanes3<W> x_row = load3<W>(sums.u_y_y, first), yz_rows = load3<W>(sums.u_y_y + 3, first);
  return {dot(load3<W>(sums.uy, first), v4),
          {dot(x_row, v4), dot({x_row.y, yz_rows.x, yz_rows.y}, v4),
           dot({x_row.z, yz_rows.y, yz_rows.z}, v4)},
          {dot(load3<W>(sums.u_n_y[0], first), v4), dot(load3<W>(sums.u_n_y[1], first), v4),
           dot(load3<W>(sums.u_n_y[2], first), v4)},
          dot(load3<W>(sums.u_yn_y, first), v4),
          dot(load3<W>(sums.u_yy_y, first), v4)};
}

template <int W>
inline LaneSphere<W> fit_sphere(const LaneMoments<W>& m) {
  LaneSphere<W> s;
  s.inverse_w = 1.0f / (m.w > 0.0f ? m.w : splat<W>(1.0f));
  s.a = m.pn - dot(m.p, m.n) * s.inverse_w;
  s.spread = m.pp - dot(m.p, m.p) * s.inverse_w;
  s.b = s.spread > 0.0f ? s.spread : splat<W>(1.0f);
  s.uq = 0.5f * s.a / s.b;
  s.ul = s.inverse_w * (m.n - (2.0f * s.uq) * m.p);
  s.uc = -s.inverse_w * (dot(s.ul, m.p) + s.uq * m.pp);
  return s;
}

template <int W>
inline Floats<W> size_of(const Lanes3<W>& v) {
  return square_root(dot(v, v));
}

/// What the fit is worth when every sum may be off by `rounding` of the sizes of its terms: the
/// error is carried through the equations of fit_sphere() to first order.
template <int W>
inline Floats<W> judge(const LaneMoments<W>& m, const LaneSums& sums, int first,
                       const LaneSphere<W>& s, Floats<W> length, float rounding) {
  // The largest errors let through: of the gradient, relative to it, since where it is small it
  // follows the noise of the normals; of 1 + uq and of the derivatives.
  constexpr float kGradient = 2e-2f, kCurvature = 1e-3f;
  constexpr auto kLength = static_cast<float>(kSmallestLength);
  constexpr auto kSpread = static_cast<float>(4.0 * kSmallestSqSpread);  // with room for rounding
  const Floats<W> inverse_w = s.inverse_w;
  const Floats<W> loss =
      rounding * load<W>(sums.u + first) * inverse_w;  // w is what u leaves of u r^2
  const Floats<W> sq_radius = m.pp * inverse_w, radius = square_root(positive_part(sq_radius));
  const Floats<W> centre = inverse_w * size_of(m.p);  // at most the radius
  const Floats<W> uq = absolute(s.uq);
  const Floats<W> e_uq = loss * (radius + 2.0f * uq * sq_radius) / (inverse_w * s.b);
  const Floats<W> e_ul = loss + 2.0f * (e_uq * centre + loss * uq * radius);
  const auto weighed = (m.w > 0.0f) & (4.0f * loss < kCurvature);
  const auto spread = ((s.spread > kSpread * m.w) & (e_uq < kCurvature * (1.0f + uq))) |
                      (m.pp == 0.0f);  // all in the very place: no curvature
  // A Pratt norm far smaller than the gradient means a pile far away, and then e_ul is large.
  const auto directed = e_ul < kGradient * length;
  const auto cancelled = weighed & (length + e_ul < kLength);
  return cancelled                     ? splat<W>(kVoid)
         : weighed & spread & directed ? splat<W>(kSound)
                                       : splat<W>(kDoubtful);
}

}  // namespace
}  // namespace pcednet::gls
