#pragma once

#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

#include "pcednet/core/vec3.h"

namespace pcednet::detect {

/// Points evenly spread along the curve, each with others near it.
struct NearOnCurve {
  static constexpr std::size_t kNear = 12;
  static constexpr std::size_t kSamples = 2000;

  std::vector<std::uint32_t> points;      ///< at most kSamples
  std::vector<std::uint32_t> neighbours;  ///< points x kNear, nearest first

  std::span<const std::uint32_t> of(std::size_t point) const {
    return std::span(neighbours).subspan(kNear * point, kNear);
  }
};

/// The kNear nearest among the 64 around a point on the curve, without copies. Points with fewer
/// are left out. `curve` is the spatial::curve_order() of the positions.
NearOnCurve near_on_curve(std::span<const Vec3> positions, std::span<const std::uint32_t> curve);

}  // namespace pcednet::detect
