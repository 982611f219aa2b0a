#pragma once

#include <Eigen/Core>
#include <algorithm>
#include <span>
#include <vector>

#include "pcednet/core/vec3.h"
#include "pcednet/gls/fit_limits.h"
#include "pcednet/spatial/kd_tree.h"

namespace pcednet::gls {

/// How much a neighbour with normal `n` counts for a point with normal `own` when neighbourhoods
/// are to keep to one side of a thin wall: clamp((n . own - a) / kGateWidth, 0, 1). It depends
/// neither on x nor on t, so every derivative holds with the weight multiplied by it.
inline double side_gate(const Vec3& n, const Vec3& own, double a) {
  return std::clamp((n.dot(own) - a) / kGateWidth, 0.0, 1.0);
}

/// A neighbour as seen from the evaluation point x, held as the row of numbers that are weighted
/// and summed.
class LocalNeighbour {
 public:
  /// 1, y, n, y.n, |y|^2 and the gate.
  using Row = Eigen::Matrix<double, 10, 1>;

  /// y = p_j - x with sq_distance = |y|^2, n of unit length, gate a side_gate() or 1.
  LocalNeighbour(const Vec3& y, const Vec3& n, double sq_distance, double gate) {
    row_ << 1.0, y, n, y.dot(n), sq_distance, gate;
  }

  const Row& row() const { return row_; }
  Vec3 y() const { return row_.segment<3>(1); }
  Vec3 n() const { return row_.segment<3>(4); }
  double sq_distance() const { return row_[8]; }
  double gate() const { return row_[9]; }

 private:
  Row row_;
};

using Neighbourhood = std::vector<LocalNeighbour>;

/// Orders `neighbours` by shell, the shell of a neighbour being the first of the ascending `radii`
/// that it is closer than, and keeps their order within a shell. The neighbourhood of each radius
/// is a prefix then, as if they were sorted. All must be closer than the last radius, and the
/// number of radii a power of two; `scratch` is overwritten.
void order_by_shell(std::span<const double> radii, std::vector<spatial::Neighbour>& neighbours,
                    std::vector<spatial::Neighbour>& scratch);

}  // namespace pcednet::gls
