#pragma once

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <vector>

#include "pcednet/cloud/class_table.h"
#include "pcednet/core/random_vectors.h"
#include "pcednet/core/vec3.h"
#include "pcednet/lines/find_lines.h"

namespace pcednet::lines {

inline constexpr double kNear = 0.7;  // of an edge: spacings that are labelled

/// Points with normals and labels.
struct Cloud {
  std::vector<Vec3> positions = {}, normals = {};
  std::vector<std::uint8_t> classes = {};
  double spacing = 0.0;

  void add(const Vec3& position, const Vec3& normal, bool edge) {
    positions.push_back(position);
    normals.push_back(normal);
    classes.push_back(edge ? kSharpEdge : kNonEdge);
  }
};

/// Points uniform on the surface of the unit cube.
inline Cloud cube(std::size_t points) {
  Random random(1);
  Cloud cloud{.spacing = std::sqrt(6.0 / static_cast<double>(points))};
  for (std::size_t i = 0; i < points; ++i) {
    const auto axis = static_cast<Eigen::Index>(random.index(3));
    const double side = random.index(2) == 0 ? 0.0 : 1.0;
    Vec3 p = uniform_vector(random);
    p[axis] = side;
    double nearest = 1.0;
    for (Eigen::Index other = 0; other < 3; ++other) {
      if (other != axis) nearest = std::min({nearest, p[other], 1.0 - p[other]});
    }
    Vec3 normal = Vec3::Zero();
    normal[axis] = side == 0.0 ? -1.0 : 1.0;
    cloud.add(p, normal, nearest < kNear * cloud.spacing);
  }
  return cloud;
}

inline EdgePoints points_of(const Cloud& cloud) {
  return {cloud.positions, cloud.normals, cloud.classes};
}

inline std::vector<Curve> lines_of(const Cloud& cloud, const LineOptions& options = {}) {
  return find_lines(points_of(cloud), options);
}

}  // namespace pcednet::lines
