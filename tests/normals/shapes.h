#pragma once

#include <Eigen/Geometry>
#include <cmath>
#include <cstddef>
#include <numbers>
#include <vector>

#include "pcednet/core/random_vectors.h"
#include "pcednet/core/vec3.h"

namespace pcednet::normals {

/// Points of a surface with their outward unit normals.
struct Shape {
  std::vector<Vec3> positions;
  std::vector<Vec3> normals;
};

inline void append(Shape& shape, const Shape& other, const Vec3& offset) {
  for (const Vec3& p : other.positions) shape.positions.push_back(p + offset);
  shape.normals.insert(shape.normals.end(), other.normals.begin(), other.normals.end());
}

inline Shape sphere(std::size_t count, double radius, std::uint64_t seed = 1) {
  Random random(seed);
  Shape shape;
  while (shape.positions.size() < count) {
    const Vec3 v = uniform_vector(random, -Vec3::Ones(), Vec3::Ones());
    if (v.norm() > 1.0 || v.norm() < 0.1) continue;
    shape.normals.push_back(v.normalized());
    shape.positions.push_back(radius * shape.normals.back());
  }
  return shape;
}

/// The surface of the box [0, size], `steps` points along each side of a face, off its edges.
inline Shape box(const Vec3& size, int steps, double jitter = 0.0) {
  Random random(2);
  Shape shape;
  for (int axis = 0; axis < 3; ++axis) {
    const int u = (axis + 1) % 3, v = (axis + 2) % 3;
    for (int side = 0; side < 2; ++side) {
      for (int i = 0; i < steps * steps; ++i) {
        Vec3 p = Vec3::Zero(), n = Vec3::Zero();
        p[axis] = side * size[axis];
        p[u] = (i / steps + 0.5 + jitter * random.uniform(-1, 1)) / steps * size[u];
        p[v] = (i % steps + 0.5 + jitter * random.uniform(-1, 1)) / steps * size[v];
        n[axis] = side == 0 ? -1.0 : 1.0;
        shape.positions.push_back(p);
        shape.normals.push_back(n);
      }
    }
  }
  return shape;
}

inline Shape torus(std::size_t count, double ring, double tube) {
  Random random(3);
  Shape shape;
  for (std::size_t i = 0; i < count; ++i) {
    const double a = random.uniform(0, 2 * std::numbers::pi);
    const double b = random.uniform(0, 2 * std::numbers::pi);
    const Vec3 out(std::cos(a), std::sin(a), 0);
    shape.normals.push_back(std::cos(b) * out + std::sin(b) * Vec3::UnitZ());
    shape.positions.push_back(ring * out + tube * shape.normals.back());
  }
  return shape;
}

/// The side of a cylinder around z, without its ends.
inline Shape open_cylinder(std::size_t count, double radius, double height) {
  Random random(4);
  Shape shape;
  for (std::size_t i = 0; i < count; ++i) {
    const double a = random.uniform(0, 2 * std::numbers::pi);
    shape.normals.emplace_back(std::cos(a), std::sin(a), 0);
    shape.positions.push_back(radius * shape.normals.back() +
                              Vec3(0, 0, random.uniform(0, height)));
  }
  return shape;
}

/// The share of `normals` on the same side as those of the shape.
inline double agreement(const Shape& shape, const std::vector<Vec3>& normals) {
  std::size_t agreeing = 0;
  for (std::size_t i = 0; i < normals.size(); ++i) agreeing += normals[i].dot(shape.normals[i]) > 0;
  return static_cast<double>(agreeing) / static_cast<double>(normals.size());
}

/// The angle between two directions, signs apart.
inline double angle_between_lines(const Vec3& a, const Vec3& b) {
  return std::atan2(a.cross(b).norm(), std::abs(a.dot(b)));
}

}  // namespace pcednet::normals
