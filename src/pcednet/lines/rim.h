#pragma once

#include <cstdint>
#include <optional>

#include "pcednet/lines/fit.h"
#include "pcednet/lines/ordered_points.h"

namespace pcednet::lines {

/// Where a narrow cylinder ends in a plane across its axis.
struct Rim {
  Fit circle;    ///< its axis points along the wall
  bool is_bore;  ///< the plane is around the circle; otherwise within it: a pin
};

/// The rim near an edge point; none if there is none with a radius of 1.5 to 6 spacings. `reach` is
/// the largest distance of points from wall and plane, in spacings.
std::optional<Rim> rim_near(const OrderedPoints& cloud, std::uint32_t edge_point, double reach,
                            double spacing);

}  // namespace pcednet::lines
