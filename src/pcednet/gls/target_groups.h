#pragma once

#include <cstdint>
#include <span>

#include "pcednet/core/vec3.h"

namespace pcednet::gls {

/// Points that are evaluated together: a stretch of the curve whose start is a multiple of it.
inline constexpr std::size_t kPointsTogether = 4096;

/// Reorders points, given in curve order, within each stretch of kPointsTogether, so that every run
/// of 8 (and of 16, 32, ...) from its start is compact in space: the stretch is halved across the
/// longest side of its box, again and again. The result depends on where the points are, not on
/// their numbers.
void arrange_in_groups(std::span<const Vec3> positions, std::span<std::uint32_t> order);

}  // namespace pcednet::gls
