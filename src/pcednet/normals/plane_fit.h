#pragma once

#include <cstdint>
#include <span>

#include "pcednet/core/vec3.h"

namespace pcednet::normals {

/// The plane through the surroundings of a point.
struct PlaneFit {
  Vec3 normal = Vec3::Zero();  ///< unit length, or zero if there is no plane
  double thickness = 0.0;      ///< smallest eigenvalue over the middle one, from 0 to 1
};

/// Fits a plane to `points[point]` and its `neighbours` (nearest first, all distinct) as told at
/// estimate_normals().
PlaneFit fit_plane(std::span<const Vec3> points, std::size_t point,
                   std::span<const std::uint32_t> neighbours);

}  // namespace pcednet::normals
