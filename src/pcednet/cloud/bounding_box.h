#pragma once

#include <algorithm>
#include <limits>
#include <span>

#include "pcednet/core/vec3.h"

namespace pcednet {

/// The axis-aligned box of the finite points; empty (min > max) if there are none.
struct BoundingBox {
  Vec3 min = Vec3::Constant(std::numeric_limits<double>::infinity());
  Vec3 max = Vec3::Constant(-std::numeric_limits<double>::infinity());

  bool empty() const { return !(min.x() <= max.x()); }
  Vec3 centre() const { return min + 0.5 * (max - min); }
  bool holds(const Vec3& p) const {
    return (p.array() >= min.array()).all() && (p.array() <= max.array()).all();
  }
  bool meets(const BoundingBox& other) const {
    return (min.array() <= other.max.array()).all() && (other.min.array() <= max.array()).all();
  }
  /// Extends it to hold the finite point, or the other box.
  void add(const Vec3& p) { add(BoundingBox{p, p}); }
  void add(const BoundingBox& other) {
    min = min.cwiseMin(other.min);
    max = max.cwiseMax(other.max);
  }
  /// The largest coordinate of a point that it holds, without its sign.
  double farthest() const { return std::max(min.cwiseAbs().maxCoeff(), max.cwiseAbs().maxCoeff()); }
  double diagonal() const { return empty() ? 0.0 : (max - min).norm(); }
};

/// Throws Error(kInsufficient) for finite coordinates beyond 1e150, whose squared distances would
/// overflow; names the first such point.
void check_extent(std::span<const Vec3> positions);

BoundingBox bounding_box(std::span<const Vec3> positions);

/// The box of the middle 96 % of the places along each axis, widened on all sides by twice its
/// longest side: points outside are far from all others. `places` must be finite; empty if there
/// are none.
BoundingBox box_of_most(std::span<const Vec3> places);

}  // namespace pcednet
