#include "pcednet/detect/principal_axes.h"

#include <cmath>
#include <limits>

#include "pcednet/core/vector_clones.h"

namespace pcednet::detect {
namespace {

constexpr std::size_t kLanes = SymmetricMatrices::kLanes;
constexpr int kMostSteps = 90;
constexpr double kTiny = std::numeric_limits<double>::min();
constexpr double kInversePrecision = 1.0 / std::numeric_limits<double>::epsilon();

/// Tridiagonal matrices T with Q T Q^T of the given ones, which converge to diagonal ones.
struct Tridiagonals {
  alignas(64) double d0[kLanes], d1[kLanes], d2[kLanes];  ///< the diagonal
  double e0[kLanes], e1[kLanes];                          ///< beside it
  double q0[3][kLanes], q1[3][kLanes], q2[3][kLanes];     ///< the columns of Q
  double scale[kLanes];
  double start[kLanes], end[kLanes];  ///< the block at work; it ends with 0
};

PCEDNET_VECTOR_CLONES
void make_tridiagonal(const SymmetricMatrices& m, Tridiagonals& __restrict t) {
  for (std::size_t i = 0; i < kLanes; ++i) {
    const double diagonal =
        larger(larger(std::fabs(m.xx[i]), std::fabs(m.yy[i])), std::fabs(m.zz[i]));
    const double rest = larger(larger(std::fabs(m.yx[i]), std::fabs(m.zx[i])), std::fabs(m.zy[i]));
    const double most = larger(diagonal, rest), scale = most == 0.0 ? 1.0 : most;
    const double xx = m.xx[i] / scale, yx = m.yx[i] / scale, zx = m.zx[i] / scale;
    const double yy = m.yy[i] / scale, zy = m.zy[i] / scale, zz = m.zz[i] / scale;
    const double sq_zx = zx * zx;
    const bool done = sq_zx <= kTiny;
    const double beta = std::sqrt(yx * yx + sq_zx), inverse = 1.0 / (done ? 1.0 : beta);
    const double a = yx * inverse, b = zx * inverse;
    const double q = 2.0 * a * zy + b * (zz - yy);
    t.scale[i] = scale;
    t.d0[i] = xx, t.d1[i] = done ? yy : yy + b * q, t.d2[i] = done ? zz : zz - b * q;
    t.e0[i] = done ? yx : beta, t.e1[i] = done ? zy : zy - a * q;
    t.q0[0][i] = 1.0, t.q0[1][i] = 0.0, t.q0[2][i] = 0.0;
    t.q1[0][i] = 0.0, t.q1[1][i] = done ? 1.0 : a, t.q1[2][i] = done ? 0.0 : b;
    t.q2[0][i] = 0.0, t.q2[1][i] = done ? 0.0 : b, t.q2[2][i] = done ? 1.0 : -a;
    t.start[i] = 0.0, t.end[i] = 2.0;
  }
}

/// 0 if it is negligible beside the diagonal entries a and b.
[[gnu::always_inline]] inline double without_dust(double e, double a, double b) {
  const double scaled = kInversePrecision * e;
  const double rest = scaled * scaled <= std::fabs(a) + std::fabs(b) ? 0.0 : e;
  return std::fabs(e) < kTiny ? 0.0 : rest;
}

/// Finds the block to work on; returns whether any matrix has one.
PCEDNET_VECTOR_CLONES
bool find_blocks(Tridiagonals& __restrict t) {
  double sum = 0.0;
  for (std::size_t i = 0; i < kLanes; ++i) {
    const double end = t.end[i], start = t.start[i];
    const double clean_0 = without_dust(t.e0[i], t.d0[i], t.d1[i]);
    const double clean_1 = without_dust(t.e1[i], t.d1[i], t.d2[i]);
    const double e0 = start == 0.0 ? (end > 0.0 ? clean_0 : t.e0[i]) : t.e0[i];
    const double e1 = end > 1.0 ? clean_1 : t.e1[i];
    const double end_1 = end > 1.0 ? (e1 == 0.0 ? 1.0 : 2.0) : end;
    const double end_0 = end_1 == 1.0 ? (e0 == 0.0 ? 0.0 : 1.0) : end_1;
    const double start_2 = e0 == 0.0 ? 1.0 : 0.0;
    t.e0[i] = e0, t.e1[i] = e1, t.end[i] = end_0;
    t.start[i] = end_0 > 1.0 ? start_2 : end_0 > 0.0 ? 0.0 : start;
  }
  for (std::size_t i = 0; i < kLanes; ++i) sum += t.end[i];
  return sum > 0.0;
}

struct Rotation {
  double c, s;
};

/// The Givens rotation that takes z to 0; neither is 0.
[[gnu::always_inline]] inline Rotation rotation(double x, double z) {
  const bool flat = std::fabs(x) > std::fabs(z);
  const double over = flat ? x : z, under = flat ? z : x;
  const double t = under / over, root = std::sqrt(1.0 + t * t);
  const double u = over < 0.0 ? -root : root;
  const double first = (flat ? 1.0 : -1.0) / u, second = -t * first;
  const double c = flat ? first : second, s = flat ? second : first;
  return {x == 0.0 ? 0.0 : c, x == 0.0 ? (z < 0.0 ? 1.0 : -1.0) : s};
}

/// One step of the QR algorithm with Wilkinson's shift.
PCEDNET_VECTOR_CLONES
void step(Tridiagonals& __restrict t) {
  for (std::size_t i = 0; i < kLanes; ++i) {
    const bool works = t.end[i] > 0.0, whole = t.end[i] == 2.0;
    const bool upper = t.start[i] == 0.0, both = whole & upper & works;
    const double d0 = t.d0[i], d1 = t.d1[i], d2 = t.d2[i], e0 = t.e0[i], e1 = t.e1[i];
    const double e = whole ? e1 : e0, last = whole ? d2 : d1, before = whole ? d1 : d0;
    const double td = (before - last) * 0.5, sq_e = e * e;
    const double size_t = std::fabs(td), size_e = std::fabs(e);
    const double p = larger(size_t, size_e), ratio = (size_t < size_e ? size_t : size_e) / p;
    const double h = p * std::sqrt(1.0 + ratio * ratio);
    const double sum = td + (td > 0.0 ? h : -h);
    const double shift = td == 0.0 ? size_e : sq_e == 0.0 ? e / (sum / e) : sq_e / sum;
    const double mu = last - shift;

    // The first rotation, of rows 0 and 1 or 1 and 2.
    const double a = upper ? d0 : d1, b = upper ? e0 : e1, f = upper ? d1 : d2;
    const Rotation r = rotation(a - mu, b);
    const double sdk = r.s * a + r.c * b, dkp1 = r.s * b + r.c * f;
    const double new_a = r.c * (r.c * a - r.s * b) - r.s * (r.c * b - r.s * f);
    const double new_f = r.s * sdk + r.c * dkp1, new_b = r.c * sdk - r.s * dkp1;
    const double d0_1 = upper ? new_a : d0, d1_1 = upper ? new_f : new_a, d2_1 = upper ? d2 : new_f;
    const double e0_1 = upper ? new_b : e0, e1_1 = both ? r.c * e1 : upper ? e1 : new_b;

    // The second, of rows 1 and 2, where the block is the whole matrix.
    const double z = -r.s * e1;
    const bool goes_on = both & (z != 0.0);
    const Rotation g = rotation(new_b, z);
    const double sdk_2 = g.s * d1_1 + g.c * e1_1, dkp1_2 = g.s * e1_1 + g.c * d2_1;
    const double d1_2 = g.c * (g.c * d1_1 - g.s * e1_1) - g.s * (g.c * e1_1 - g.s * d2_1);
    const double d2_2 = g.s * sdk_2 + g.c * dkp1_2, e1_2 = g.c * sdk_2 - g.s * dkp1_2;
    const double e0_2 = g.c * e0_1 - g.s * z;

    t.d0[i] = works ? d0_1 : d0;
    t.d1[i] = works ? (goes_on ? d1_2 : d1_1) : d1;
    t.d2[i] = works ? (goes_on ? d2_2 : d2_1) : d2;
    t.e0[i] = works ? (goes_on ? e0_2 : e0_1) : e0;
    t.e1[i] = works ? (goes_on ? e1_2 : e1_1) : e1;
    for (int k = 0; k < 3; ++k) {
      const double q0 = t.q0[k][i], q1 = t.q1[k][i], q2 = t.q2[k][i];
      const double left = upper ? q0 : q1, right = upper ? q1 : q2;
      const double new_left = r.c * left - r.s * right, new_right = r.s * left + r.c * right;
      const double q0_1 = upper ? new_left : q0, q1_1 = upper ? new_right : new_left;
      const double q2_1 = upper ? q2 : new_right;
      const double q1_2 = g.c * q1_1 - g.s * q2_1, q2_2 = g.s * q1_1 + g.c * q2_1;
      t.q0[k][i] = works ? q0_1 : q0;
      t.q1[k][i] = works ? (goes_on ? q1_2 : q1_1) : q1;
      t.q2[k][i] = works ? (goes_on ? q2_2 : q2_1) : q2;
    }
  }
}

/// Eigen's selection sort, without the position of the smallest value.
PCEDNET_VECTOR_CLONES
void take_largest(const Tridiagonals& t, PrincipalAxes& __restrict axes) {
  for (std::size_t i = 0; i < kLanes; ++i) {
    const double d0 = t.d0[i], d1 = t.d1[i], d2 = t.d2[i];
    const double smaller = d1 < d0 ? d1 : d0, greater = d1 < d0 ? d0 : d1;
    // The values in second and third place once the smallest is first.
    const double second = d2 < smaller ? d1 : greater, third = d2 < smaller ? d0 : d2;
    axes.largest[i] = (third < second ? second : third) * t.scale[i];
    axes.middle[i] = (third < second ? third : second) * t.scale[i];
    for (int k = 0; k < 3; ++k) {
      const double q0 = t.q0[k][i], q1 = t.q1[k][i], q2 = t.q2[k][i];
      const double of_greater = d1 < d0 ? q0 : q1;
      const double of_second = d2 < smaller ? q1 : of_greater, of_third = d2 < smaller ? q0 : q2;
      axes.axis[k][i] = third < second ? of_second : of_third;
    }
  }
}

}  // namespace

void find_principal_axes(const SymmetricMatrices& matrices, PrincipalAxes& axes) {
  Tridiagonals t;
  make_tridiagonal(matrices, t);
  for (int steps = 0; find_blocks(t) && steps < kMostSteps; ++steps) step(t);
  take_largest(t, axes);
}

}  // namespace pcednet::detect
