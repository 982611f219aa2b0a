#pragma once

#include <Eigen/Core>
#include <cmath>

#include "pcednet/core/vec3.h"

namespace pcednet {

/// A direction as a point of the unfolded octahedron |x| + |y| + |z| = 1 (Cigolle et al. 2014), in
/// [-1, 1] x [-1, 1]. Any length is valid; zero becomes +z. Stores a normal in a few bytes.
inline Eigen::Vector2d octahedral(const Vec3& direction) {
  const double sum = direction.cwiseAbs().sum();
  if (!(sum > 0)) return Eigen::Vector2d::Zero();
  const double u = direction.x() / sum, v = direction.y() / sum;
  if (direction.z() >= 0) return {u, v};
  return {std::copysign(1 - std::abs(v), u), std::copysign(1 - std::abs(u), v)};
}

}  // namespace pcednet
