#pragma once

#include <cmath>
#include <cstdint>
#include <vector>

#include "pcednet/core/progress.h"
#include "pcednet/core/vec3.h"
#include "pcednet/lines/points/ordered_points.h"

namespace pcednet::lines {

/// A plane and the points that were found on it.
struct PlanePatch {
  Vec3 point, normal;                  ///< the sign of the normal is arbitrary
  double reach;                        ///< of its points, a hundredth of a spacing
  std::vector<std::uint32_t> members;  ///< ascending

  double height(const Vec3& place) const { return normal.dot(place - point); }
  bool is_on(const Vec3& place) const { return std::abs(height(place)) < reach; }
};

/// The planes near probable edges of a cloud of exact points, each with eight points or more. They
/// follow from positions alone, so that those of thin plates and narrow steps are found, where
/// normals and labels mislead.
std::vector<PlanePatch> find_exact_planes(const OrderedPoints& cloud, double spacing,
                                          const Progress* progress);

}  // namespace pcednet::lines
