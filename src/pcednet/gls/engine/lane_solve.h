#pragma once

#include "pcednet/gls/engine/lane_fit.h"

/// From the sums of a neighbourhood to its description, a target per lane and in units of the
/// support radius, where every feature is free of units as it stands: the equations of
/// descriptor.h.
namespace pcednet::gls {
namespace {  // each unit has its own copy, see simd.h

template <int W>
struct LaneChange {
  Floats<W> uq, uc;
  Lanes3<W> ul;
};

/// What describes a usable sphere, and the two inverse lengths that its derivatives need.
template <int W>
struct LaneFrame {
  Floats<W> inverse_pratt, inverse_length;
  Lanes3<W> eta;
};

template <int W>
inline LaneChange<W> differentiate(const LaneMoments<W>& m, const LaneMoments<W>& d,
                                   const LaneSphere<W>& s) {
  const Floats<W> iw = s.inverse_w;
  const Floats<W> da = d.pn - (dot(m.n, d.p) + dot(m.p, d.n)) * iw + dot(m.p, m.n) * d.w * iw * iw;
  const Floats<W> db = d.pp - 2.0f * dot(m.p, d.p) * iw + dot(m.p, m.p) * d.w * iw * iw;
  LaneChange<W> r;
  r.uq = (0.5f * da - s.uq * db) / s.b;
  r.ul = iw * (d.n - d.w * s.ul - (s.uq + s.uq) * d.p - (r.uq + r.uq) * m.p);
  r.uc = -iw * (dot(m.p, r.ul) + dot(s.ul, d.p) + m.pp * r.uq + s.uq * d.pp + s.uc * d.w);
  return r;
}

template <int W>
struct TauKappa {
  Floats<W> tau, kappa;
};

/// d tau and d kappa for a change of the sphere; `shift` is what d/dx adds to d uc for tau.
template <int W>
inline TauKappa<W> derivatives(const LaneSphere<W>& s, const LaneFrame<W>& f,
                               const LaneChange<W>& d, Floats<W> shift) {
  const Floats<W> dpratt2 = 2.0f * dot(s.ul, d.ul) - 4.0f * (s.uq * d.uc + s.uc * d.uq);
  const Floats<W> half_cube = 0.5f * dpratt2 * f.inverse_pratt * f.inverse_pratt * f.inverse_pratt;
  return {(d.uc + shift) * f.inverse_pratt - s.uc * half_cube,
          2.0f * (d.uq * f.inverse_pratt - s.uq * half_cube)};
}

/// The signed principal curvatures from the change of the normal along two tangents.
template <int W>
inline void put_curvatures(const LaneMoments<W>& m, const LaneSums& sums, int first,
                           const LaneSphere<W>& s, const LaneFrame<W>& f, LaneFits& out) {
  const Floats<W> zero{}, one = splat<W>(1.0f);
  const auto steep = absolute(f.eta.x) > 0.6f;
  Lanes3<W> t1 = cross(f.eta, {steep ? zero : one, steep ? one : zero, zero});
  t1 = (1.0f / square_root(dot(t1, t1))) * t1;
  const Lanes3<W> t2 = cross(f.eta, t1);
  const Lanes3<W> d1 = differentiate(m, spatial_derivative(sums, first, t1), s).ul;
  const Lanes3<W> d2 = differentiate(m, spatial_derivative(sums, first, t2), s).ul;
  const Floats<W> m11 = (dot(t1, d1) + 2.0f * s.uq) * f.inverse_length;
  const Floats<W> m22 = (dot(t2, d2) + 2.0f * s.uq) * f.inverse_length;
  const Floats<W> m12 = 0.5f * (dot(t1, d2) + dot(t2, d1)) * f.inverse_length;
  const Floats<W> mean = 0.5f * (m11 + m22), half = 0.5f * (m11 - m22);
  const Floats<W> spread = square_root(half * half + m12 * m12);
  const Floats<W> side = mean != 0.0f ? mean : s.uq;
  store(out.features[2] + first, side < 0.0f ? mean - spread : mean + spread);
  store(out.features[6] + first, side < 0.0f ? mean + spread : mean - spread);
}

/// eta, its derivatives, and the spatial ones of tau and kappa: the features that turn with the
/// cloud.
template <int W>
inline void put_vectors(const LaneMoments<W>& m, const LaneSums& sums, int first,
                        const LaneSphere<W>& s, const LaneFrame<W>& f, const LaneChange<W>& dt,
                        LaneFits& out) {
  const auto tangential = [&](const Lanes3<W>& v) {
    return f.inverse_length * (v - dot(v, f.eta) * f.eta);
  };
  store3(out.features + 7, first, f.eta);
  store3(out.features + 10, first, tangential(dt.ul));
  const Floats<W> zero{}, one = splat<W>(1.0f);
  const Lanes3<W> axes[3] = {{one, zero, zero}, {zero, one, zero}, {zero, zero, one}};
  const Floats<W> gradient[3] = {s.ul.x, s.ul.y, s.ul.z};
  for (int k = 0; k < 3; ++k) {
    const LaneChange<W> d = differentiate(m, spatial_derivative(sums, first, axes[k]), s);
    const TauKappa<W> change = derivatives(s, f, d, gradient[k]);
    store(out.features[13 + k] + first, change.tau);
    store(out.features[16 + k] + first, change.kappa);
    const Lanes3<W> deta = tangential(d.ul + (2.0f * s.uq) * axes[k]);
    store(out.features[19 + k] + first, deta.x);
    store(out.features[22 + k] + first, deta.y);
    store(out.features[25 + k] + first, deta.z);
  }
}

/// kDoubtful where a feature is not finite, kSound elsewhere.
template <int W>
inline Floats<W> finiteness(const LaneFits& fits, int first, int features) {
  Floats<W> sum{};
  for (int k = 0; k < features; ++k) {
    const Floats<W> feature = load<W>(fits.features[k] + first);
    sum += feature - feature;
  }
  return sum == 0.0f ? splat<W>(kSound) : splat<W>(kDoubtful);
}

template <int W>
inline void solve_lanes(const LaneSums& sums, int first, LaneDetail detail, float rounding,
                        LaneFits& out) {
  const LaneMoments<W> m = moments_of<W>(sums, first);
  const LaneSphere<W> s = fit_sphere(m);
  const Floats<W> sq_length = dot(s.ul, s.ul), sq_pratt = sq_length - 4.0f * s.uc * s.uq;
  const Floats<W> length = square_root(sq_length);
  const Floats<W> verdict = judge(m, sums, first, s, length, rounding);
  const Floats<W> one = splat<W>(1.0f);
  const Floats<W> pratt = square_root(verdict == kSound ? sq_pratt : one);
  const Floats<W> inverse_length = one / (verdict == kSound ? length : one);
  const LaneFrame<W> f = {one / pratt, inverse_length, inverse_length * s.ul};
  store(out.pratt + first, pratt);
  store(out.uc + first, s.uc), store3(out.ul, first, s.ul), store(out.uq + first, s.uq);

  const LaneChange<W> dt = differentiate(m, scale_derivative(sums, first, m), s);
  const TauKappa<W> change = derivatives(s, f, dt, Floats<W>{});
  store(out.features[0] + first, s.uc * f.inverse_pratt);
  store(out.features[1] + first, 2.0f * s.uq * f.inverse_pratt);
  store(out.features[3] + first, change.tau);
  store(out.features[4] + first, change.kappa);
  store(out.features[5] + first, at_most(positive_part(1.0f - sq_pratt), 1.0f));
  if (detail != LaneDetail::kRelief) put_curvatures(m, sums, first, s, f, out);
  if (detail == LaneDetail::kAll) put_vectors(m, sums, first, s, f, dt, out);
  const int features = detail == LaneDetail::kAll ? 28 : 7;
  store(out.verdict + first, verdict == kSound ? finiteness<W>(out, first, features) : verdict);
}

template <int W>
void solve(const LaneSums& sums, LaneDetail detail, float rounding, LaneFits& fits) {
  for (int first = 0; first < static_cast<int>(kLanes); first += W) {
    solve_lanes<W>(sums, first, detail, rounding, fits);
  }
}

}  // namespace
}  // namespace pcednet::gls
