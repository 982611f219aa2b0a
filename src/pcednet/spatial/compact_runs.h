#pragma once

#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

#include "pcednet/core/vec3.h"

namespace pcednet::spatial {

/// Cuts points that lie along a space-filling curve into compact runs of at most `most`: where the
/// curve jumps, one run ends and another begins. Returns the first point of each run, and the
/// number of points at the end. Any order is cut; that of curve_order() gives small runs.
std::vector<std::uint32_t> cut_compact_runs(std::span<const Vec3> points, std::size_t most);

}  // namespace pcednet::spatial
