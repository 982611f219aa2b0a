#pragma once

#include <array>
#include <cstddef>
#include <optional>
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
  Row edginess;                      ///< probability of an edge, where normals are unreliable

  void add(const Vec3& offset, const Vec3& normal, double probability);
  Vec3 offset(std::size_t i) const { return {x[i], y[i], z[i]}; }
  Vec3 normal(std::size_t i) const { return {normal_x[i], normal_y[i], normal_z[i]}; }
};

struct LocalPlane {
  Vec3 normal;
  double distance;  ///< points x of the plane: normal . x = distance
  int support;      ///< points on it and on no plane found before

  double operator()(const Vec3& x) const { return normal.dot(x) - distance; }
};

/// Sums over weighted points, which determine their least-squares plane.
struct Moments {
  double weight = 0.0;
  Vec3 sum = Vec3::Zero();
  Mat3 products = Mat3::Zero();

  void add(const Vec3& p, double w = 1.0) {
    weight += w;
    sum += w * p;
    products += w * p * p.transpose();
  }
  void add(const Moments& other) {
    weight += other.weight;
    sum += other.sum;
    products += other.products;
  }
  Vec3 mean() const { return sum / weight; }
  Mat3 covariance() const { return products / weight - mean() * mean().transpose(); }
};

/// Their plane; none if their weight is below `least_weight`, or if they are collinear: the
/// variance along their shorter side is not above `least_width`.
std::optional<LocalPlane> plane_of(const Moments& moments, double least_weight, double least_width);

/// The planes that explain the points, at most four, the one with most support first. A point is on
/// a plane if it is nearer than `tolerance`.
void find_planes(const NearPoints& points, double tolerance, std::vector<LocalPlane>& planes);

}  // namespace pcednet::lines
