#pragma once

#include <array>
#include <cstddef>
#include <vector>

#include "pcednet/core/vec3.h"

namespace pcednet::lines {

/// The points near another, relative to it and in spacings, nearest first.
struct NearPoints {
  static constexpr std::size_t kMost = 112;
  using Row = std::array<double, kMost>;

  std::size_t count = 0;
  Row x, y, z;
  Row normal_x, normal_y, normal_z;  ///< unit or zero
  Row edginess;                      ///< probability of an edge: its normal is not to be trusted

  void add(const Vec3& offset, const Vec3& normal, double probability);
  Vec3 offset(std::size_t i) const { return {x[i], y[i], z[i]}; }
  Vec3 normal(std::size_t i) const { return {normal_x[i], normal_y[i], normal_z[i]}; }
};

struct LocalPlane {
  Vec3 normal;
  double distance;  ///< points x of the plane: normal . x = distance
  int support;      ///< points on it that are on none found before

  double operator()(const Vec3& x) const { return normal.dot(x) - distance; }
};

/// The planes that explain the points, the one with most support first, at most four. A point is on
/// a plane if it is nearer than `tolerance`.
void find_planes(const NearPoints& points, double tolerance, std::vector<LocalPlane>& planes);

}  // namespace pcednet::lines
