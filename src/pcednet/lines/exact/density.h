#pragma once

#include "pcednet/core/vec3.h"

namespace pcednet::lines {

/// Nearest others that tell how dense points are.
inline constexpr std::size_t kNearby = 48;

/// Whether the cloud is five times as fine around a point as the spacing of the whole, which
/// exact surfaces follow: they leave such points to the creases.
inline bool is_too_dense(double sq_distance_to_last_nearby, double spacing) {
  constexpr double kTooDense = 0.8;  // spacings
  return sq_distance_to_last_nearby < kTooDense * kTooDense * spacing * spacing;
}

}  // namespace pcednet::lines
