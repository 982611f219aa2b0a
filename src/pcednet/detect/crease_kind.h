#pragma once

#include <cstdint>
#include <span>

#include "pcednet/detect/classify.h"

namespace pcednet::detect {

/// Tells sharp-edge from smooth-edge beside it anew, for exact points: where a point has a distance
/// d to a crease (crease_distances(), in units of `smallest_scale`), the log-odds that an edge is
/// sharp become
///
///     0.55 log(p_sharp / p_smooth) + 1 if d is below 0.48, or - 2.15 beyond
///
/// with a change over 0.02 between. The probability of an edge stays. Fitted to the labels of clean
/// parts (`pcednet generate lines`, seeds 901 and 902), whose bands they are.
///
/// `curve` is the spatial::curve_order() of the positions, `smallest_scale` that of the description
/// for the networks, some 1.2 spacings.
void apply_crease_kind(std::span<const Vec3> positions, std::span<const std::uint32_t> curve,
                       double smallest_scale, Classification& found);

}  // namespace pcednet::detect
