#pragma once

#include <cmath>

#include "pcednet/lines/exact/cylinders.h"
#include "pcednet/lines/exact/planes.h"
#include "pcednet/lines/points/plane_line.h"

namespace pcednet::lines {

/// A plane, or the half of a cylinder around a line along it: what has a fold at this line.
struct FoldSurface {
  Vec3 normal;               ///< at the line, unit
  Vec3 point;                ///< of the plane, or of the cylinder's axis
  double reach;              ///< of its points
  double radius = 0.0;       ///< 0: a plane
  Vec3 axis = Vec3::Zero();  ///< of the cylinder, unit

  bool is_on(const Vec3& place) const {
    const Vec3 offset = place - point;
    if (radius == 0.0) return std::abs(normal.dot(offset)) < reach;
    const Vec3 spoke = offset - axis.dot(offset) * axis;
    return normal.dot(spoke) > 0.0 && std::abs(spoke.norm() - radius) < reach;
  }
};

inline FoldSurface surface_of(const PlanePatch& plane) {
  return {plane.normal, plane.point, plane.reach};
}

/// The line is along the cylinder.
inline FoldSurface surface_of(const ExactCylinder& cylinder, const PlaneLine& line) {
  const Vec3 spoke = line.point - cylinder.circle.point;
  const Vec3& axis = cylinder.circle.direction;
  return {(spoke - axis.dot(spoke) * axis).normalized(), cylinder.circle.point, cylinder.reach,
          cylinder.circle.radius, axis};
}

}  // namespace pcednet::lines
