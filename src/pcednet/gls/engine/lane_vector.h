#pragma once

#include "pcednet/core/simd.h"
#include "pcednet/gls/engine/lane_types.h"

namespace pcednet::gls {
namespace {  // each unit has its own copy, see simd.h

/// Vectors in space, W at a time.
template <int W>
struct Lanes3 {
  Floats<W> x, y, z;
};

template <int W>
inline Lanes3<W> operator+(const Lanes3<W>& a, const Lanes3<W>& b) {
  return {a.x + b.x, a.y + b.y, a.z + b.z};
}

template <int W>
inline Lanes3<W> operator-(const Lanes3<W>& a, const Lanes3<W>& b) {
  return {a.x - b.x, a.y - b.y, a.z - b.z};
}

template <int W>
inline Lanes3<W> operator*(const Floats<W>& s, const Lanes3<W>& v) {
  return {s * v.x, s * v.y, s * v.z};
}

template <int W>
inline Floats<W> dot(const Lanes3<W>& a, const Lanes3<W>& b) {
  return a.x * b.x + (a.y * b.y + a.z * b.z);
}

template <int W>
inline Lanes3<W> cross(const Lanes3<W>& a, const Lanes3<W>& b) {
  return {a.y * b.z - a.z * b.y, a.z * b.x - a.x * b.z, a.x * b.y - a.y * b.x};
}

template <int W>
inline Lanes3<W> load3(const float (*rows)[kLanes], int first) {
  return {load<W>(rows[0] + first), load<W>(rows[1] + first), load<W>(rows[2] + first)};
}

template <int W>
inline void store3(float (*rows)[kLanes], int first, const Lanes3<W>& v) {
  store(rows[0] + first, v.x), store(rows[1] + first, v.y), store(rows[2] + first, v.z);
}

}  // namespace
}  // namespace pcednet::gls
