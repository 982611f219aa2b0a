#pragma once

#include <array>
#include <cstddef>
#include <optional>
#include <vector>

#include "pcednet/core/vec3.h"
#include "pcednet/lines/points/moments.h"

namespace pcednet::lines {

/// The points near another, relative to it and in spacings, nearest first.
struct NearPoints {
  static constexpr std::size_t kMost = 112;
  using Row = std::array<double, kMost>;

  // 0 beyond the points.
  std::size_t count = 0;
  Row x{}, y{}, z{};
  Row normal_x{}, normal_y{}, normal_z{};  ///< unit or zero
  Row edginess{};                          ///< probability of an edge, where normals are unreliable

  void add(const Vec3& offset, const Vec3& normal, double probability);
  Vec3 offset(std::size_t i) const { return {x[i], y[i], z[i]}; }
  Vec3 normal(std::size_t i) const { return {normal_x[i], normal_y[i], normal_z[i]}; }
  PointMoments moments(const Row& weight) const {
    return moments_of(x.data(), y.data(), z.data(), weight.data(), count);
  }
};

struct LocalPlane {
  Vec3 normal;
  double distance;  ///< points x of the plane: normal . x = distance
  int support;      ///< points on it and on no plane found before

  double height(const Vec3& x) const { return normal.dot(x) - distance; }
};

inline constexpr double kSameNormal = 0.75;  ///< cosine of a plane's normal and of its points'

/// Two half-planes that meet in a line.
struct Wedge {
  Vec3 at;              ///< the point of the line nearest to the origin
  Vec3 along;           ///< unit
  Vec3 side_a, side_b;  ///< unit, orthogonal to `along`: in each plane, away from the line
};

/// The least-squares plane of points; none if their weight is below `least_weight`, or if they are
/// collinear: the variance along their shorter side is not above `least_width`.
std::optional<LocalPlane> plane_of(const PointMoments& moments, double least_weight,
                                   double least_width);

/// The planes that explain the points, at most four, the one with most support first. A point is on
/// a plane if it is nearer than `tolerance`.
void find_planes(const NearPoints& points, double tolerance, std::vector<LocalPlane>& planes);

}  // namespace pcednet::lines
