#pragma once

#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>
#include <span>
#include <vector>

#include "pcednet/core/vec3.h"
#include "pcednet/spatial/kd_tree.h"

namespace pcednet::spatial {

/// The widest angle around a point in which there is no direction; radians.
struct Opening {
  double middle;  ///< in (-pi, 2 pi)
  double width;   ///< in (0, 2 pi]
};

/// The widest opening between the directions `angles`, one or more from std::atan2; sorts them.
inline Opening widest_opening(std::span<double> angles) {
  std::sort(angles.begin(), angles.end());
  Opening best{angles.back() + std::numbers::pi, 0.0};
  for (std::size_t i = 0; i < angles.size(); ++i) {
    const bool last = i + 1 == angles.size();
    const double next = last ? angles.front() + 2.0 * std::numbers::pi : angles[i + 1];
    if (next - angles[i] > best.width) best = {0.5 * (angles[i] + next), next - angles[i]};
  }
  return best;
}

/// Whether the surface goes on beyond an opening in the direction `outward`: within 45 degrees of
/// it, and 20 of the plane, there is a point at most twice as far as the nearest of `others`
/// behind. So it is between scan lines that are farther from each other than their points: the
/// nearest are those of one side.
///
/// `others` are the nearest of `points` to `at`; position_of(index) is the position of one.
template <typename Points, typename PositionOf>
bool goes_on_beyond(const Points& points, const Vec3& at, const Vec3& outward, const Vec3& normal,
                    std::span<const Neighbour> others, const PositionOf& position_of) {
  constexpr double kTwice = 4.0, kCone = 0.5, kOffPlane = 0.117;  // as squares
  const auto is_towards = [&](const Neighbour& other, const Vec3& direction) {
    const Vec3 offset = position_of(other.index) - at;
    const double along = direction.dot(offset), height = normal.dot(offset);
    return along > 0.0 && along * along > kCone * other.sq_distance &&
           height * height < kOffPlane * other.sq_distance;
  };
  double behind = std::numeric_limits<double>::infinity();
  for (const Neighbour& other : others) {
    if (is_towards(other, -outward)) behind = std::min(behind, other.sq_distance);
  }
  // All points as near as these are among the others.
  if (!(kTwice * behind > others.back().sq_distance) || std::isinf(behind)) return false;
  std::vector<Neighbour> near;
  points.within(at, std::sqrt(kTwice * behind), near);
  return std::any_of(near.begin(), near.end(),
                     [&](const Neighbour& other) { return is_towards(other, outward); });
}

}  // namespace pcednet::spatial
