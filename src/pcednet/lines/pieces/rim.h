#pragma once

#include <cstdint>
#include <optional>
#include <span>

#include "pcednet/lines/curves/fit.h"
#include "pcednet/lines/points/ordered_points.h"

namespace pcednet::lines {

/// Where a narrow cylinder ends in a plane across its axis.
struct Rim {
  Fit circle;    ///< its axis points along the wall
  bool is_bore;  ///< the plane is around the circle; otherwise within it: a pin
};

/// What the points around a rim must be like.
struct RimTest {
  double reach;         ///< largest distance of points from wall and plane, in spacings
  std::size_t plane;    ///< least number of points of the plane
  std::size_t missing;  ///< of eight parts of the circle, those that may have no points
  double off;           ///< largest number of points beside the wall to one of it
  double share;         ///< of the points seen from the edge point, those of the wall
};

/// The rim near an edge point; none if there is none with a radius of 1.5 to 6 spacings. Axes are
/// sought among the normals of planes near the point and in `common_axes`.
std::optional<Rim> rim_near(const OrderedPoints& cloud, std::uint32_t edge_point,
                            std::span<const Vec3> common_axes, const RimTest& test, double spacing);

}  // namespace pcednet::lines
