#pragma once

#include <optional>

#include "pcednet/lines/points/local_planes.h"

namespace pcednet::lines {

// Where the points lie that a side of a wedge is judged by, in spacings.
inline constexpr double kSliceAlong = 1.6;  ///< to both sides along the line
inline constexpr double kSideReach = 3.0;   ///< away from it

/// In spacings.
struct WedgeTolerances {
  double plane;  ///< from a plane to its points
  double first;  ///< from the line to the nearest points of a side
  double noise;
};

/// The best wedge that two planes around a point, which is the origin, make there; none if no pair
/// has points on one side of their line each. Nearly exact points are on the planes of a chamfer of
/// a spacing and more; else planes may meet off the surface, beyond a chamfer or a fillet.
std::optional<Wedge> best_plane_wedge(const NearPoints& points, const WedgeTolerances& within);

}  // namespace pcednet::lines
