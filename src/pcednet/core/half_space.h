#pragma once

#include "pcednet/core/vec3.h"

namespace pcednet {

/// True for exactly one of v and -v, unless v is zero.
inline bool points_down(const Vec3& v) {
  if (v.z() != 0.0) return v.z() < 0.0;
  return v.y() != 0.0 ? v.y() < 0.0 : v.x() < 0.0;
}

/// The one of v and -v that does not point down: results computed from it do not change in any bit
/// when normals are flipped.
inline Vec3 upward(const Vec3& v) {
  return points_down(v) ? Vec3(-v) : v;
}

/// The one of v and -v within 90 degrees of `sense`.
inline Vec3 turned_to(const Vec3& v, const Vec3& sense) {
  return v.dot(sense) < 0.0 ? Vec3(-v) : v;
}

}  // namespace pcednet
