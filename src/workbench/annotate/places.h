#pragma once

#include <cstdint>
#include <optional>
#include <span>
#include <vector>

#include "pcednet/spatial/kd_tree.h"

namespace pcednet::annotate {

/// The points of least confidence, the least first, none closer to an earlier one than `apart`; at
/// most `most`. `tree` is of `positions`; points that are not finite are left out.
std::vector<std::uint32_t> rank_uncertain(std::span<const Vec3> positions,
                                          const spatial::KdTree& tree,
                                          std::span<const float> confidence, double apart,
                                          std::size_t most = 200);

struct Picked {
  std::uint32_t point = 0;
  double distance = 0;  ///< along the ray
};

/// The first point within `radius` of the ray from `origin` along `direction` (any length but 0).
std::optional<Picked> pick(std::span<const Vec3> positions, const Vec3& origin,
                           const Vec3& direction, double radius);

}  // namespace pcednet::annotate
