#pragma once

#include <Eigen/Core>
#include <algorithm>
#include <span>
#include <vector>

#include "pcednet/core/vec3.h"
#include "pcednet/gls/fit_limits.h"
#include "pcednet/spatial/kd_tree.h"

namespace pcednet::gls {

/// The factor on the weight of a neighbour with normal `n` for a point with normal `own`, which
/// keeps neighbourhoods to one side of a thin wall: clamp((n . own - a) / kGateWidth, 0, 1). It
/// depends neither on x nor on t, so every derivative scales with it.
inline double side_gate(const Vec3& n, const Vec3& own, double a) {
  return std::clamp((n.dot(own) - a) / kGateWidth, 0.0, 1.0);
}

/// A neighbour relative to the evaluation point x, stored as the row of numbers that are weighted
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

/// Orders `neighbours` by shell and keeps their order within a shell; the shell of a neighbour is
/// the first of the ascending `radii` that exceeds its distance. The neighbourhood of each radius
/// is then a prefix, as in a sorted list. All must be closer than the last radius, and the number
/// of radii must be a power of two; `scratch` is overwritten.
void order_by_shell(std::span<const double> radii, std::vector<spatial::Neighbour>& neighbours,
                    std::vector<spatial::Neighbour>& scratch);

}  // namespace pcednet::gls
