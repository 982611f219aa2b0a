#pragma once

#include <cmath>
#include <vector>

#include "pcednet/core/random.h"
#include "pcednet/core/vec3.h"

namespace pcednet {

constexpr double kNearestGround = 5.5, kFarthestGround = 28.3;  // from below the scanner

/// A sector of 2 radians of level ground as a scanner 1.7 above it sees it, with noise of 3 mm
/// along the beam: far away its rows are ten times as far from each other as their points.
inline std::vector<Vec3> scanned_ground() {
  constexpr double kHeight = 1.7, kStep = 0.004;
  Random random(3);
  std::vector<Vec3> positions;
  for (double down = 0.06; down < 0.3; down += kStep) {
    for (double turn = 0.0; turn < 2.0; turn += kStep) {
      const double range = kHeight / std::sin(down) + 0.003 * random.normal();
      positions.emplace_back(range * std::cos(down) * std::cos(turn),
                             range * std::cos(down) * std::sin(turn),
                             kHeight - range * std::sin(down));
    }
  }
  return positions;
}

}  // namespace pcednet
