#pragma once

#include <cstdint>
#include <span>

#include "pcednet/detect/classify.h"

namespace pcednet::detect {

/// Re-estimates, for exact points, whether an edge is sharp or smooth: at a distance d to a crease
/// (crease_distances(), in units of `smallest_scale`), the log-odds that an edge is sharp become
///
///     0.55 log(p_sharp / p_smooth) + 1 if d is below 0.48, or - 2.15 beyond
///
/// with a transition 0.02 wide. The probability of an edge stays. Fitted to the label bands of
/// clean parts (`pcednet generate lines`, seeds 901 and 902).
///
/// `curve` is the spatial::curve_order() of the positions, `smallest_scale` that of the networks'
/// description, about 1.2 spacings. Points with an edge probability below `least_edge` stay, as for
/// the context network.
void apply_crease_kind(std::span<const Vec3> positions, std::span<const std::uint32_t> curve,
                       double smallest_scale, float least_edge, Classification& found);

}  // namespace pcednet::detect
