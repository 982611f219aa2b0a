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

  std::size_t near = kNear;
  std::vector<std::uint32_t> points;      ///< at most kSamples
  std::vector<std::uint32_t> neighbours;  ///< points x near, nearest first

  std::span<const std::uint32_t> of(std::size_t point) const {
    return std::span(neighbours).subspan(near * point, near);
  }
};

/// The `count` nearest to the point at `place`, nearest first, of as many as `around` on either
/// side of it in `places`, points along a curve; fewer if there are not enough.
std::vector<std::uint32_t> nearest_on_curve(std::span<const Vec3> positions,
                                            std::span<const std::uint32_t> places,
                                            std::size_t place, std::size_t around,
                                            std::size_t count);

/// The `near` nearest among some five times as many around a point on the curve, without copies.
/// Points with fewer are left out. `curve` is the spatial::curve_order() of the positions.
NearOnCurve near_on_curve(std::span<const Vec3> positions, std::span<const std::uint32_t> curve,
                          std::size_t near = NearOnCurve::kNear);

}  // namespace pcednet::detect
