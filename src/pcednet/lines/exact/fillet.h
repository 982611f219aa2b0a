#pragma once

#include <Eigen/Core>
#include <optional>
#include <span>
#include <vector>

#include "pcednet/lines/exact/strip.h"

namespace pcednet::lines {

/// A point near the corner of two lines that meet at an angle, which are surfaces seen along their
/// edge. Lengths are in spacings.
struct CornerPoint {
  double along;        ///< the edge
  Eigen::Vector2d at;  ///< from the corner: along the line that halves the angle, and across
};

/// A rounded corner: an arc that touches both lines.
struct Fillet {
  double radius;
  double depth;                     ///< of the middle of the arc, from the corner
  std::vector<Interval> intervals;  ///< along the edge
};

/// The fillet in the corner of two lines, each turned by `half_angle` from the one that halves
/// their angle: points are on the arc, and on the lines only where it ends.
std::optional<Fillet> find_fillet(std::span<const CornerPoint> points, double half_angle);

}  // namespace pcednet::lines
