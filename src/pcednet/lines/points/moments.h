#pragma once

#include <cstddef>

#include "pcednet/core/vec3.h"

namespace pcednet::lines {

/// Sums over weighted points, which determine their least-squares plane. Plain numbers, so that
/// sums of sums stay in vector registers.
struct PointMoments {
  double weight = 0.0, x = 0.0, y = 0.0, z = 0.0;
  double xx = 0.0, xy = 0.0, yy = 0.0, xz = 0.0, yz = 0.0, zz = 0.0;

  void add(const Vec3& p, double w = 1.0) {
    const double wx = w * p.x(), wy = w * p.y(), wz = w * p.z();
    weight += w;
    x += wx, y += wy, z += wz;
    xx += wx * p.x(), xy += wy * p.x(), yy += wy * p.y();
    xz += wz * p.x(), yz += wz * p.y(), zz += wz * p.z();
  }
  void operator+=(const PointMoments& other) {
    weight += other.weight;
    x += other.x, y += other.y, z += other.z;
    xx += other.xx, xy += other.xy, yy += other.yy;
    xz += other.xz, yz += other.yz, zz += other.zz;
  }
  void operator-=(const PointMoments& other) {
    weight -= other.weight;
    x -= other.x, y -= other.y, z -= other.z;
    xx -= other.xx, xy -= other.xy, yy -= other.yy;
    xz -= other.xz, yz -= other.yz, zz -= other.zz;
  }
  Vec3 mean() const { return Vec3(x, y, z) / weight; }
  Mat3 covariance() const {
    Mat3 products;
    products << xx, xy, xz, xy, yy, yz, xz, yz, zz;
    return products / weight - mean() * mean().transpose();
  }
};

/// Sums over places in a plane, which determine their least-squares line.
struct FlatMoments {
  double count = 0.0;
  Eigen::Vector2d sum = Eigen::Vector2d::Zero();
  Eigen::Matrix2d products = Eigen::Matrix2d::Zero();

  void add(const Eigen::Vector2d& place) {
    count += 1.0, sum += place, products += place * place.transpose();
  }
  Eigen::Vector2d mean() const { return sum / count; }
  Eigen::Matrix2d covariance() const { return products / count - mean() * mean().transpose(); }
};

/// The moments of `count` points in rows, each with its weight. The rows go on to a multiple of
/// four with weights of 0 and any finite places.
PointMoments moments_of(const double* x, const double* y, const double* z, const double* weight,
                        std::size_t count);

}  // namespace pcednet::lines
