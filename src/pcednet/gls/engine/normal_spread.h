#pragma once

#include <Eigen/LU>

#include "pcednet/core/vec3.h"

namespace pcednet::gls {

/// Measures whether normals point in all directions, as on leaves and in noise, or belong to one or
/// two surfaces.
class NormalSpread {
 public:
  void add(const Vec3& normal, double weight) {
    const double w = weight * normal.squaredNorm();
    outer_ += weight * normal * normal.transpose();
    sum_ += w, squares_ += w * w, cubes_ += w * w * w;
  }

  /// The mean square of the volume [n_i n_j n_k] over all triples of different normals, of unit
  /// length: 0 if all lie in one plane, as beside an edge; 6 s^4 on a plane with noise s per axis;
  /// 2/9 if they point in all directions. By the Cauchy-Binet formula the sum of these squares is
  /// det(sum w n n^T). 0 for fewer than three normals.
  double mean_sq_volume() const {
    const double triples = (sum_ * (sum_ * sum_ - 3.0 * squares_) + 2.0 * cubes_) / 6.0;
    if (!(triples > 1e-6 * sum_ * sum_ * sum_)) return 0.0;
    return outer_.determinant() / triples;
  }

 private:
  Mat3 outer_ = Mat3::Zero();
  double sum_ = 0.0, squares_ = 0.0, cubes_ = 0.0;
};

}  // namespace pcednet::gls
