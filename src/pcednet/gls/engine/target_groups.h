#pragma once

#include <cstdint>
#include <span>

#include "pcednet/core/vec3.h"

namespace pcednet::gls {

/// The number of points evaluated together: a range of the curve that starts at a multiple of it.
inline constexpr std::size_t kPointsTogether = 4096;

/// Reorders points, given in curve order, within each range of kPointsTogether, so that every run
/// of 8 (and of 16, 32, ...) from its start is compact in space: the range is halved recursively
/// across the longest side of its box. The result depends on the positions, not on the numbering.
void arrange_in_groups(std::span<const Vec3> positions, std::span<std::uint32_t> order);

}  // namespace pcednet::gls
