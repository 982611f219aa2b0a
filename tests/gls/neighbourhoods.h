#pragma once

#include <Eigen/Geometry>
#include <vector>

#include "gls/test_clouds.h"
#include "pcednet/gls/neighbourhood.h"

namespace pcednet::gls::test {

inline LocalNeighbour neighbour(const Vec3& y, const Vec3& n, double gate = 1.0) {
  return {y, n, y.squaredNorm(), gate};
}

/// The same points seen from `x` (relative to where they were seen from before), nearer than `t`.
inline Neighbourhood seen_from(const Neighbourhood& neighbours, const Vec3& x, double t) {
  Neighbourhood moved;
  for (const LocalNeighbour& old : neighbours) {
    const LocalNeighbour fresh = neighbour(old.y() - x, old.n(), old.gate());
    if (fresh.sq_distance() < t * t) moved.push_back(fresh);
  }
  return moved;
}

/// A bumpy, noisy piece of surface around 0 within `radius`: nothing about it is symmetric.
/// `gated` gives the neighbours random gates.
inline Neighbourhood random_neighbourhood(Stream& stream, int count, double radius, bool gated) {
  const Vec3 axis = stream.direction();
  const Vec3 b1 = axis.unitOrthogonal(), b2 = axis.cross(b1);
  Neighbourhood neighbours;
  while (neighbours.size() < static_cast<std::size_t>(count)) {
    const double u = 2 * stream.uniform() - 1, v = 2 * stream.uniform() - 1;
    const double height = 0.1 + 0.4 * u * u - 0.2 * u * v + 0.05 * stream.normal();
    const Vec3 y = radius * (u * b1 + v * b2 + height * axis);
    const Vec3 n = (axis - (0.8 * u - 0.2 * v) * b1 + 0.2 * u * b2 + 0.1 * stream.normal3());
    const double gate = gated ? stream.uniform() : 1.0;
    if (y.norm() < radius) neighbours.push_back(neighbour(y, n.normalized(), gate));
  }
  return neighbours;
}

/// A fine square grid over the plane of `u` and `v` around 0, nearer than 1, as (a, b) pairs of
/// cell centres: sums over it are integrals to 1e-3.
template <typename Action>
void for_grid(Action&& action) {
  constexpr int kCells = 100;
  for (int i = -kCells; i < kCells; ++i) {
    for (int j = -kCells; j < kCells; ++j) {
      const double a = (i + 0.5) / kCells, b = (j + 0.5) / kCells;
      if (a * a + b * b < 1.0) action(a, b);
    }
  }
}

}  // namespace pcednet::gls::test
