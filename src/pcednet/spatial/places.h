#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "pcednet/core/vec3.h"

namespace pcednet::spatial {

/// The places where points are, along a curve: points with the same position share one.
struct Places {
  std::vector<std::uint32_t> order = {};   ///< of the points, place by place
  std::vector<std::uint32_t> starts = {};  ///< of the places in it, and its length; empty while no
                                           ///< points coincide
  std::vector<Vec3> positions = {};        ///< of the places

  std::size_t size() const { return positions.size(); }
  std::span<const std::uint32_t> points(std::size_t place) const {
    if (starts.empty()) return std::span(order).subspan(place, 1);
    return std::span(order).subspan(starts[place], starts[place + 1] - starts[place]);
  }
};

/// The places of the points in `order`: the curve_order() of the positions, or a part of it.
Places places_of(std::span<const Vec3> positions, std::vector<std::uint32_t> order);

}  // namespace pcednet::spatial
