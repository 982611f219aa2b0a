#pragma once

#include <cstddef>

#include "pcednet/core/vec3.h"
#include "pcednet/lines/points/local_planes.h"

namespace pcednet::lines {

/// Least squares heights are fitted in it: z is across the points, the origin their mean.
struct Frame {
  Vec3 origin, x, y, z;

  Vec3 of(const Vec3& place) const {
    const Vec3 offset = place - origin;
    return {offset.dot(x), offset.dot(y), offset.dot(z)};
  }
  Vec3 place(const Vec3& local) const {
    return origin + local.x() * x + local.y() * y + local.z() * z;
  }
};

/// The nearest points in their frame.
struct FramedPoints {
  Frame frame;
  Vec3 origin;  ///< the edge point
  std::size_t count;
  NearPoints::Row x{}, y{}, z{};

  FramedPoints(const NearPoints& points, std::size_t count);

 private:
  void project(const NearPoints& points, const Vec3& axis, NearPoints::Row& row) const;
};

/// The sum of squared distances of the points to the best quadratic height, to first order, each at
/// most `sq_most`.
double error_of_quadric(const FramedPoints& points, double sq_most);

}  // namespace pcednet::lines
