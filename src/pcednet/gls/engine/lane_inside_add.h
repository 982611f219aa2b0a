#pragma once

#include "pcednet/gls/engine/lane_vector.h"

/// The polynomials of lane_inside_sums.h at the targets, a target per lane.
namespace pcednet::gls {
namespace {  // each unit has its own copy, see simd.h

/// Where the targets are, about the centre, and the weight u = count (a + 2 p.x - rho) there.
template <int W>
struct InsidePlace {
  Lanes3<W> x;
  Floats<W> xx, a;

  InsidePlace(const LaneTargets& targets, int first, const float centre[3]) {
    x = {load<W>(targets.x + first) - centre[0], load<W>(targets.y + first) - centre[1],
         load<W>(targets.z + first) - centre[2]};
    xx = dot(x, x), a = 1.0f - xx;
  }

  /// S u m from S m, S p m, S rho m.
  Floats<W> weigh(float m, const Floats<W>& xpm, float rm) const {
    return a * m + (2.0f * xpm - rm);
  }
  Floats<W> along(float mx, float my, float mz) const { return x.x * mx + (x.y * my + x.z * mz); }
};

/// S u f for f = weight {1, p, rho}.
template <int W>
struct InsideRow {
  Floats<W> one, rho;
  Lanes3<W> p;

  InsideRow(const InsidePlace<W>& at, const float (&s)[15]) {
    one = at.weigh(s[0], at.along(s[1], s[2], s[3]), s[10]);
    p.x = at.weigh(s[1], at.along(s[4], s[5], s[6]), s[11]);
    p.y = at.weigh(s[2], at.along(s[5], s[7], s[8]), s[12]);
    p.z = at.weigh(s[3], at.along(s[6], s[8], s[9]), s[13]);
    rho = at.weigh(s[10], at.along(s[11], s[12], s[13]), s[14]);
  }
};

template <typename V>
inline void accumulate(float* to, V value) {
  store(to, load<kWidthOf<V>>(to) + value);
}

template <int W>
inline void accumulate3(float (*rows)[kLanes], int first, const Lanes3<W>& v) {
  accumulate(rows[0] + first, v.x), accumulate(rows[1] + first, v.y);
  accumulate(rows[2] + first, v.z);
}

/// What needs no normal: y = p - x, r^2 = rho - 2 p.x + x.x.
template <int W>
inline void add_inside_positions(const InsideSums& inside, const InsidePlace<W>& at, int first,
                                 LaneSums& sums) {
  using Lanes = Floats<W>;
  const InsideRow<W> m(at, inside.moments[0]);
  const Lanes3<W>& x = at.x;
  const float(&s)[15] = inside.moments[0];
  const float(&h)[20] = inside.higher;
  const Lanes xx = at.weigh(s[4], at.along(h[6], h[7], h[8]), h[0]);
  const Lanes xy = at.weigh(s[5], at.along(h[7], h[9], h[10]), h[1]);
  const Lanes xz = at.weigh(s[6], at.along(h[8], h[10], h[11]), h[2]);
  const Lanes yy = at.weigh(s[7], at.along(h[9], h[12], h[13]), h[3]);
  const Lanes yz = at.weigh(s[8], at.along(h[10], h[13], h[14]), h[4]);
  const Lanes zz = at.weigh(s[9], at.along(h[11], h[14], h[15]), h[5]);
  const Lanes3<W> rp = {at.weigh(s[11], at.along(h[0], h[1], h[2]), h[16]),
                        at.weigh(s[12], at.along(h[1], h[3], h[4]), h[17]),
                        at.weigh(s[13], at.along(h[2], h[4], h[5]), h[18])};
  const Lanes rr = at.weigh(s[14], at.along(h[16], h[17], h[18]), h[19]);
  const Lanes3<W> pp_x = {dot({xx, xy, xz}, x), dot({xy, yy, yz}, x), dot({xz, yz, zz}, x)};
  const Lanes px = dot(m.p, x);
  const Lanes uyy = m.rho - 2.0f * px + at.xx * m.one;
  const Lanes urr =
      rr - 4.0f * (dot(rp, x) - dot(pp_x, x)) + at.xx * (2.0f * m.rho - 4.0f * px + at.xx * m.one);
  const Lanes3<W> uy = m.p - m.one * x;
  accumulate(sums.u + first, m.one), accumulate(sums.uyy + first, uyy);
  accumulate(sums.wyy + first, uyy - urr);
  accumulate3(sums.uy, first, uy);
  accumulate3(sums.u_yy_y, first, rp - splat<W>(2.0f) * pp_x + at.xx * m.p - uyy * x);
  const Lanes3<W> row_x = Lanes3<W>{xx, xy, xz} - x.x * m.p - uy.x * x;
  accumulate3(sums.u_y_y, first, row_x);
  accumulate(sums.u_y_y[3] + first, yy - x.y * m.p.y - uy.y * x.y);
  accumulate(sums.u_y_y[4] + first, yz - x.y * m.p.z - uy.y * x.z);
  accumulate(sums.u_y_y[5] + first, zz - x.z * m.p.z - uy.z * x.z);
}

/// Everything else: y.n = pi - n.x.
template <int W>
inline void add_inside_normals(const InsideSums& inside, const InsidePlace<W>& at, int first,
                               LaneSums& sums) {
  using Lanes = Floats<W>;
  const Lanes3<W>& x = at.x;
  const InsideRow<W> n[3] = {
      {at, inside.moments[1]}, {at, inside.moments[2]}, {at, inside.moments[3]}};
  const InsideRow<W> pi(at, inside.moments[4]);
  const Lanes3<W> un = {n[0].one, n[1].one, n[2].one}, rn = {n[0].rho, n[1].rho, n[2].rho};
  const Lanes3<W> n_p_x = {dot(n[0].p, x), dot(n[1].p, x), dot(n[2].p, x)};
  const Lanes3<W> nx_p = x.x * n[0].p + x.y * n[1].p + x.z * n[2].p;
  const Lanes nx = dot(un, x), uyn = pi.one - nx;
  const Lanes uryn = pi.rho - dot(rn, x) - 2.0f * (dot(pi.p, x) - dot(n_p_x, x)) + at.xx * uyn;
  accumulate3(sums.un, first, un);
  accumulate(sums.uyn + first, uyn), accumulate(sums.wyn + first, uyn - uryn);
  accumulate3(sums.wn, first, un - rn + splat<W>(2.0f) * n_p_x - at.xx * un);
  accumulate3(sums.u_yn_y, first, pi.p - nx_p - uyn * x);
  for (int a = 0; a < 3; ++a) accumulate3(sums.u_n_y[a], first, n[a].p - n[a].one * x);
}

template <int W>
void add_inside(const InsideSums& inside, const LaneTargets& targets, LaneSums& sums) {
  for (int first = 0; first < static_cast<int>(kLanes); first += W) {
    const InsidePlace<W> at(targets, first, inside.centre);
    add_inside_positions(inside, at, first, sums);
    add_inside_normals(inside, at, first, sums);
  }
}

}  // namespace
}  // namespace pcednet::gls
