#pragma once

#include <Eigen/Geometry>

#include "pcednet/core/vec3.h"

namespace pcednet::lines {

/// Places in a plane, in coordinates of its own.
struct Chart {
  using Flat = Eigen::Vector2d;

  /// `normal` is unit; x, y and it are right-handed.
  Chart(const Vec3& point, const Vec3& normal)
      : origin(point), x(normal.unitOrthogonal()), y(normal.cross(x)) {}

  Flat flat(const Vec3& place) const { return turned(place - origin); }
  Flat turned(const Vec3& direction) const { return {x.dot(direction), y.dot(direction)}; }
  Vec3 place(const Flat& at) const { return origin + direction(at); }
  Vec3 direction(const Flat& to) const { return to.x() * x + to.y() * y; }

  Vec3 origin, x, y;
};

}  // namespace pcednet::lines
