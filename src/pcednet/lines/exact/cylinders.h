#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "pcednet/core/progress.h"
#include "pcednet/lines/curves/fit.h"
#include "pcednet/lines/exact/planes.h"
#include "pcednet/lines/points/ordered_points.h"

namespace pcednet::lines {

/// A cylinder across an exact plane, as of a bore, a pin or a rounded corner.
struct ExactCylinder {
  Fit circle;                          ///< in the plane; its axis points along the cylinder
  double reach;                        ///< of its points: more of flat facets that approximate it
  std::vector<std::uint32_t> members;  ///< the points found on it, ascending
};

/// The cylinders that rise from the plane among `points`, which are of no plane and near it: six
/// points or more are on each. They follow from positions alone.
std::vector<ExactCylinder> find_exact_cylinders(const OrderedPoints& cloud, const PlanePatch& plane,
                                                std::span<const std::uint32_t> points,
                                                double spacing, const Progress* progress);

}  // namespace pcednet::lines
