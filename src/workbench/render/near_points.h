#pragma once

#include <array>
#include <cstdint>
#include <span>
#include <vector>

#include "pcednet/core/vec3.h"

namespace pcednet::render {

/// Some points close to a point, nearest first, exact duplicates of it left out.
struct NearPoints {
  static constexpr std::size_t kMost = 8;

  std::array<std::uint32_t, kMost> index;
  std::array<float, kMost> distance;
  std::uint32_t count = 0;
};

/// Close points of each point, from the neighbours along three space-filling curves: now and then a
/// nearer one is missed, but it takes a small part of the time of an exact search and is good
/// enough to draw with. Positions must be finite.
std::vector<NearPoints> near_points(std::span<const Vec3> positions);

}  // namespace pcednet::render
