#pragma once

#include <optional>

#include "pcednet/lines/curves/fit.h"

namespace pcednet::lines {

// The surfaces beside an edge are fitted to the points of its sides. Lengths are in spacings.
inline constexpr double kSideOfSurface = 4.0;  ///< how far the side reaches
inline constexpr double kFromEdge = 0.3;       ///< points nearer to it may be of either side
inline constexpr double kLeastOfSide = 8.0;    ///< points
inline constexpr int kSideFits = 3;            ///< with shrinking reach

/// Which points count as those of a side, and how far an edge may move to where they say.
struct SideLimits {
  double tolerance;  ///< from the surface
  double shift;

  static SideLimits in(double noise) { return {0.3 + 1.2 * noise, 0.8 + noise}; }
};

/// How a surface explains the points of a side.
struct Support {
  double points = 0.0;       ///< on it, within the tolerance
  double sq_distance = 0.0;  ///< their sum, in squared spacings
};

inline Support operator+(const Support& a, const Support& b) {
  return {a.points + b.points, a.sq_distance + b.sq_distance};
}

/// Where a piece belongs, and the angle of the surfaces that meet there.
struct Placed {
  Fit fit;
  std::optional<double> dihedral = {};
  Support support = {};  ///< of both surfaces
};

}  // namespace pcednet::lines
