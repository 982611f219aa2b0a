#pragma once

#include <cstdint>
#include <functional>
#include <span>
#include <vector>

#include "pcednet/core/progress.h"
#include "pcednet/core/vec3.h"
#include "pcednet/detect/points/prepare.h"
#include "pcednet/gls/engine/scale_space.h"

namespace pcednet::detect {

// Where the spacing varies, as in scans from one place, no range of scales suits all points: what
// is fine near the scanner is below the spacing far from it. With ScaleSpaceOptions::octaves,
// points whose spacing is about 2, 4, 8 times s_min (octaves 1, 2, 3) are described at scales from
// that many times s_min on, up to s_max_ratio times that. Points of smaller spacing, and all
// points of even clouds, have octave 0: the scales of the cloud.

/// The octave of every point, below the gls::octave_count() of the range; 0 where a point is not
/// finite. The spacing at a point is the median over its 10 nearest others of the mean distance to
/// theirs. `curve` is the spatial::curve_order() of the positions.
std::vector<std::uint8_t> octaves_of(std::span<const Vec3> positions,
                                     std::span<const std::uint32_t> curve,
                                     const gls::ScaleRange& range);

/// Calls work(space, points) with the scale space of each octave that has points, octave 0 first
/// and always, and the points to be described in it, in the most efficient order. Together they
/// are the finite points, or those wanted of a part of a cloud. One space is held at a time.
void for_each_octave(
    const PreparedCloud& cloud, const gls::ScaleSpaceOptions& descriptor, const Progress* progress,
    const std::function<void(const gls::ScaleSpace&, std::span<const std::uint32_t>)>& work);

}  // namespace pcednet::detect
