#pragma once

#include <algorithm>
#include <vector>

#include "pcednet/core/vec3.h"

namespace pcednet::gls {

/// A neighbour as seen from the evaluation point x.
struct LocalNeighbour {
  Vec3 y;              ///< p_j - x
  Vec3 n;              ///< unit normal
  double sq_distance;  ///< |y|^2
  double gate;         ///< side_gate() of its normal; 1 without a gate
};

/// How much a neighbour with normal `n` counts for a point with normal `own` when neighbourhoods
/// are to keep to one side of a thin wall: clamp((n . own - a) / 0.3, 0, 1). It depends neither on
/// x nor on t, so every derivative holds with the weight multiplied by it.
inline double side_gate(const Vec3& n, const Vec3& own, double a) {
  constexpr double kWidth = 0.3;
  return std::clamp((n.dot(own) - a) / kWidth, 0.0, 1.0);
}

/// Neighbours nearest first: the neighbourhood of a smaller radius is a prefix.
using Neighbourhood = std::vector<LocalNeighbour>;

}  // namespace pcednet::gls
