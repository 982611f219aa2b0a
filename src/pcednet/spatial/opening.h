#pragma once

#include <algorithm>
#include <numbers>
#include <span>

namespace pcednet::spatial {

/// The widest angle around a point in which there is no direction; radians.
struct Opening {
  double middle;  ///< in (-pi, 2 pi)
  double width;   ///< in (0, 2 pi]
};

/// That of the directions `angles`, one or more from std::atan2; sorts them.
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

}  // namespace pcednet::spatial
