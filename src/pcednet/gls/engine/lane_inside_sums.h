#pragma once

#include "pcednet/gls/engine/lane_vector.h"

/// The sums over sources that are inside the support of every target: there u = count (1 - r^2) is
/// never cut off, so that each sum is a polynomial in the place of the target. Its coefficients are
/// summed once for many targets, a source per lane.
namespace pcednet::gls {
namespace {  // each unit has its own copy, see simd.h

/// The sources of one turn, about the centre, padded with nothing to full lanes.
template <int W>
struct InsideTurn {
  static constexpr std::size_t kSources = 64;
  float p[3][kSources], rho[kSources], weight[InsideSums::kWeights][kSources];
  std::size_t count;

  void take(const Source* sources, const std::uint32_t* indices, std::size_t from,
            const float centre[3]) {
    count = from;
    for (std::size_t j = 0; j < count; ++j) {
      const Source& s = sources[indices[j]];
      const float x = s.x - centre[0], y = s.y - centre[1], z = s.z - centre[2];
      p[0][j] = x, p[1][j] = y, p[2][j] = z;
      rho[j] = x * x + (y * y + (z * z + s.qq));
      weight[0][j] = s.count;
      weight[1][j] = s.count * s.nx, weight[2][j] = s.count * s.ny, weight[3][j] = s.count * s.nz;
      weight[4][j] = s.count * (x * s.nx + (y * s.ny + (z * s.nz + s.qn)));
    }
    for (; count % W != 0; ++count) {
      for (auto& row : p) row[count] = 0.0f;
      for (auto& row : weight) row[count] = 0.0f;
      rho[count] = 0.0f;
    }
  }
};

template <int W>
inline void add_moments(const InsideTurn<W>& turn, const float* weight, Floats<W> (&sums)[15]) {
  Floats<W> one = sums[0], px = sums[1], py = sums[2], pz = sums[3], xx = sums[4], xy = sums[5],
            xz = sums[6], yy = sums[7], yz = sums[8], zz = sums[9], r = sums[10], rx = sums[11],
            ry = sums[12], rz = sums[13], rr = sums[14];
  for (std::size_t j = 0; j < turn.count; j += W) {
    const Floats<W> w = load<W>(weight + j), rho = load<W>(turn.rho + j);
    const Lanes3<W> p = {load<W>(turn.p[0] + j), load<W>(turn.p[1] + j), load<W>(turn.p[2] + j)};
    const Lanes3<W> wp = w * p;
    const Floats<W> wr = w * rho;
    one += w, px += wp.x, py += wp.y, pz += wp.z;
    xx += wp.x * p.x, xy += wp.x * p.y, xz += wp.x * p.z;
    yy += wp.y * p.y, yz += wp.y * p.z, zz += wp.z * p.z;
    r += wr, rx += wr * p.x, ry += wr * p.y, rz += wr * p.z, rr += wr * rho;
  }
  sums[0] = one, sums[1] = px, sums[2] = py, sums[3] = pz, sums[4] = xx, sums[5] = xy;
  sums[6] = xz, sums[7] = yy, sums[8] = yz, sums[9] = zz, sums[10] = r, sums[11] = rx;
  sums[12] = ry, sums[13] = rz, sums[14] = rr;
}

template <int W>
inline void add_higher(const InsideTurn<W>& turn, Floats<W> (&sums)[20]) {
  Floats<W> local[20];
  for (int k = 0; k < 20; ++k) local[k] = sums[k];
  for (std::size_t j = 0; j < turn.count; j += W) {
    const Floats<W> w = load<W>(turn.weight[0] + j), rho = load<W>(turn.rho + j);
    const Lanes3<W> p = {load<W>(turn.p[0] + j), load<W>(turn.p[1] + j), load<W>(turn.p[2] + j)};
    const Floats<W> wr = w * rho, wrr = wr * rho;
    const Lanes3<W> wp = w * p;
    const Floats<W> xx = wp.x * p.x, yy = wp.y * p.y, zz = wp.z * p.z, yz = wp.y * p.z;
    local[0] += xx * rho, local[1] += wr * p.x * p.y, local[2] += wr * p.x * p.z;
    local[3] += yy * rho, local[4] += yz * rho, local[5] += zz * rho;
    local[6] += xx * p.x, local[7] += xx * p.y, local[8] += xx * p.z, local[9] += yy * p.x;
    local[10] += yz * p.x, local[11] += zz * p.x, local[12] += yy * p.y, local[13] += yy * p.z;
    local[14] += zz * p.y, local[15] += zz * p.z;
    local[16] += wrr * p.x, local[17] += wrr * p.y, local[18] += wrr * p.z;
    local[19] += wrr * rho;
  }
  for (int k = 0; k < 20; ++k) sums[k] = local[k];
}

template <int W>
void sum_inside(const Source* sources, const std::uint32_t* indices, std::size_t count,
                InsideSums& sums) {
  Floats<W> moments[InsideSums::kWeights][15] = {}, higher[20] = {};
  InsideTurn<W> turn;
  for (std::size_t begin = 0; begin < count; begin += turn.kSources) {
    const std::size_t left = count - begin;
    turn.take(sources, indices + begin, left < turn.kSources ? left : turn.kSources, sums.centre);
    for (int f = 0; f < InsideSums::kWeights; ++f) add_moments(turn, turn.weight[f], moments[f]);
    add_higher(turn, higher);
  }
  for (int f = 0; f < InsideSums::kWeights; ++f) {
    for (int k = 0; k < 15; ++k) sums.moments[f][k] = sum_of_lanes(moments[f][k]);
  }
  for (int k = 0; k < 20; ++k) sums.higher[k] = sum_of_lanes(higher[k]);
}

}  // namespace
}  // namespace pcednet::gls
