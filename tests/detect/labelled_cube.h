#pragma once

#include <Eigen/Geometry>
#include <algorithm>

#include "pcednet/cloud/point_cloud.h"
#include "pcednet/core/random_vectors.h"

namespace pcednet {

/// The surface of a unit cube, labelled by the distance to its edges.
inline PointCloud cube(std::size_t points, std::uint64_t seed) {
  Random random(seed);
  PointCloud cloud;
  for (std::size_t i = 0; i < points; ++i) {
    const auto axis = static_cast<Eigen::Index>(random.index(3));
    const double side = random.index(2) == 0 ? -0.5 : 0.5;
    Vec3 p = uniform_vector(random, Vec3::Constant(-0.5), Vec3::Constant(0.5));
    p[axis] = side;
    Vec3 away = (0.5 - p.cwiseAbs().array()).matrix();
    std::sort(away.data(), away.data() + 3);
    cloud.positions.push_back(p);
    cloud.normals.push_back(2.0 * side * Vec3::Unit(axis));
    cloud.labels.push_back(away[1] < 0.025 ? kSharpEdge : away[1] < 0.08 ? kSmoothEdge : kNonEdge);
  }
  return cloud;
}

/// The cloud with normals that nobody would estimate: turned by 17 degrees.
inline PointCloud with_own_normals(PointCloud cloud) {
  for (Vec3& normal : cloud.normals) normal = (normal + 0.3 * normal.unitOrthogonal()).normalized();
  return cloud;
}

}  // namespace pcednet
