#pragma once

#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

#include "pcednet/core/vec3.h"

namespace pcednet::spatial {

/// Cuts points along a space-filling curve into compact runs of at most `most`; a run ends where
/// the curve jumps. Returns the first point of each run, followed by the number of points. Any
/// order is valid; curve_order() gives small runs.
std::vector<std::uint32_t> cut_compact_runs(std::span<const Vec3> points, std::size_t most);

}  // namespace pcednet::spatial
