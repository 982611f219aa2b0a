#pragma once

#include "pcednet/gls/engine/lane_vector.h"
#include "pcednet/gls/fit_limits.h"

/// The contribution of one source to the sums over a neighbourhood, a target per lane.
namespace pcednet::gls {
namespace {  // each unit has its own copy, see simd.h

/// What the sums need of one source, per lane.
template <int W>
struct Interaction {
  Lanes3<W> uy;
  Floats<W> u, w, yn;
};

template <int W, bool kGated>
struct Targets {
  Lanes3<W> x, n;
  Floats<W> offset;

  Targets(const LaneTargets& t, int first, const LaneGate& gate) {
    x = {load<W>(t.x + first), load<W>(t.y + first), load<W>(t.z + first)};
    if constexpr (kGated) {
      const Floats<W> slope = splat<W>(1.0f / static_cast<float>(kGateWidth));
      n = slope * Lanes3<W>{load<W>(t.nx + first), load<W>(t.ny + first), load<W>(t.nz + first)};
      // A target without a normal has its gate open.
      offset = dot(n, n) > 0.0f ? -gate.threshold * slope : splat<W>(2.0f);
    }
  }

  Lanes3<W> relative(const Source& s) const { return {s.x - x.x, s.y - x.y, s.z - x.z}; }

  /// The gate before it is cut to [0, 1]. The mean normal of a voxel is shorter than one where its
  /// points disagree; the gate compares directions and voxels are nearly planar, so that is left.
  Floats<W> slope(const Source& s) const {
    return n.x * s.nx + (n.y * s.ny + (n.z * s.nz + offset));
  }
  Floats<W> gate(const Source& s) const { return at_most(positive_part(slope(s)), 1.0f); }
};

/// Where a source is to each target, and what it weighs before any gate.
template <int W>
struct Relation {
  Lanes3<W> y;
  Floats<W> rr, yn, rest, weight;
};

/// Where every source is a single point, count is 1 and qq and qn are 0.
template <bool kPoints, int W, bool kGated>
inline Relation<W> relate(const Source& s, const Targets<W, kGated>& targets) {
  Relation<W> r;
  r.y = targets.relative(s);
  r.rr = r.y.x * r.y.x + r.y.y * r.y.y + r.y.z * r.y.z;
  r.yn = r.y.x * s.nx + r.y.y * s.ny + r.y.z * s.nz;
  if constexpr (!kPoints) r.rr += s.qq, r.yn += s.qn;
  r.rest = positive_part(1.0f - r.rr);
  r.weight = r.rest;
  if constexpr (!kPoints) r.weight *= s.count;
  return r;
}

/// S of everything that needs no normal. Where every source is a single point, two sums are traces
/// of others.
template <int W, bool kPoints>
struct PositionSums {
  Floats<W> u{}, uyy{}, wyy{}, xx{}, xy{}, xz{}, yy{}, yz{}, zz{};
  Lanes3<W> uy{}, u_yy_y{};

  template <bool kGated>
  Interaction<W> add(const Source& s, const Targets<W, kGated>& targets) {
    const Relation<W> r = relate<kPoints>(s, targets);
    Floats<W> weight = r.weight;
    if constexpr (kGated) weight *= targets.gate(s);
    return add(r, weight);
  }

  Interaction<W> add(const Relation<W>& r, const Floats<W>& weight) {
    const Interaction<W> i = {weight * r.y, weight, weight * r.rest, r.yn};
    u += i.u, uy = uy + i.uy;
    if constexpr (!kPoints) uyy += i.u * r.rr;
    wyy += i.w * r.rr;
    u_yy_y = u_yy_y + r.rr * i.uy;
    xx += i.uy.x * r.y.x, xy += i.uy.x * r.y.y, xz += i.uy.x * r.y.z;
    yy += i.uy.y * r.y.y, yz += i.uy.y * r.y.z, zz += i.uy.z * r.y.z;
    return i;
  }

  void operator+=(const PositionSums& other) {
    u += other.u, uyy += other.uyy, wyy += other.wyy;
    xx += other.xx, xy += other.xy, xz += other.xz;
    yy += other.yy, yz += other.yz, zz += other.zz;
    uy = uy + other.uy, u_yy_y = u_yy_y + other.u_yy_y;
  }

  void store_to(LaneSums& sums, int first) const {
    store(sums.u + first, u), store(sums.wyy + first, wyy);
    store(sums.uyy + first, kPoints ? xx + yy + zz : uyy);
    store3(sums.uy, first, uy), store3(sums.u_yy_y, first, u_yy_y);
    store3<W>(sums.u_y_y, first, {xx, xy, xz}), store3<W>(sums.u_y_y + 3, first, {yy, yz, zz});
  }
};

/// S of everything else.
template <int W, bool kPoints>
struct NormalSums {
  Floats<W> uyn{}, wyn{};
  Lanes3<W> un{}, wn{}, u_yn_y{}, u_nx_y{}, u_ny_y{}, u_nz_y{};

  void add(const Source& s, const Interaction<W>& i) {
    un.x += i.u * s.nx, un.y += i.u * s.ny, un.z += i.u * s.nz;
    wn.x += i.w * s.nx, wn.y += i.w * s.ny, wn.z += i.w * s.nz;
    if constexpr (!kPoints) uyn += i.u * i.yn;
    wyn += i.w * i.yn;
    u_yn_y = u_yn_y + i.yn * i.uy;
    u_nx_y.x += i.uy.x * s.nx, u_nx_y.y += i.uy.y * s.nx, u_nx_y.z += i.uy.z * s.nx;
    u_ny_y.x += i.uy.x * s.ny, u_ny_y.y += i.uy.y * s.ny, u_ny_y.z += i.uy.z * s.ny;
    u_nz_y.x += i.uy.x * s.nz, u_nz_y.y += i.uy.y * s.nz, u_nz_y.z += i.uy.z * s.nz;
  }

  void operator+=(const NormalSums& other) {
    uyn += other.uyn, wyn += other.wyn;
    un = un + other.un, wn = wn + other.wn, u_yn_y = u_yn_y + other.u_yn_y;
    u_nx_y = u_nx_y + other.u_nx_y, u_ny_y = u_ny_y + other.u_ny_y;
    u_nz_y = u_nz_y + other.u_nz_y;
  }

  void store_to(LaneSums& sums, int first) const {
    store3(sums.un, first, un), store3(sums.wn, first, wn), store3(sums.u_yn_y, first, u_yn_y);
    store(sums.uyn + first, kPoints ? u_nx_y.x + u_ny_y.y + u_nz_y.z : uyn);
    store(sums.wyn + first, wyn);
    store3(sums.u_n_y[0], first, u_nx_y), store3(sums.u_n_y[1], first, u_ny_y);
    store3(sums.u_n_y[2], first, u_nz_y);
  }
};

}  // namespace
}  // namespace pcednet::gls
