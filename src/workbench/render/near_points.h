#pragma once

#include <array>
#include <cstdint>
#include <span>
#include <vector>

#include "pcednet/core/vec3.h"

namespace pcednet::render {

/// Some points close to a point, nearest first, without its exact duplicates.
struct NearPoints {
  static constexpr std::size_t kMost = 8;

  std::array<std::uint32_t, kMost> index;
  std::array<float, kMost> distance;
  std::uint32_t count = 0;
};

/// Approximate nearest neighbours of each point, from the neighbours along three space-filling
/// curves. Much faster than an exact search; it misses some neighbours, which suffices for drawing.
/// Positions must be finite.
std::vector<NearPoints> near_points(std::span<const Vec3> positions);

}  // namespace pcednet::render
