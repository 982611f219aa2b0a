#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "pcednet/core/vec3.h"

namespace pcednet::lines {

/// A point near another, relative to it and in spacings.
struct NearPoint {
  Vec3 offset;
  Vec3 normal;     ///< unit or zero
  float edginess;  ///< probability of an edge: its normal is then not to be trusted
};

struct LocalPlane {
  Vec3 normal;
  double distance;  ///< points x of the plane: normal . x = distance
  double support;   ///< points on it that are on none found before

  double operator()(const Vec3& x) const { return normal.dot(x) - distance; }
};

/// The planes that explain the points, the one with most support first, at most four. A point is on
/// a plane if it is nearer than `tolerance`.
void find_planes(std::span<const NearPoint> points, double tolerance,
                 std::vector<LocalPlane>& planes);

}  // namespace pcednet::lines
