#pragma once

#include <cstdint>
#include <optional>
#include <span>
#include <string>

#include "pcednet/core/vec3.h"

namespace pcednet::detect {

/// Noise about as thick as the spacing or thicker, as of hand-held scanners.
struct ThickNoise {
  double deviation;  ///< standard deviation across the surface
  double spacing;    ///< of the points, projected on it

  /// The edge of voxels whose means have so little of it that edges show.
  double voxel() const { return 2.4 * deviation; }
};

/// "noise is 2.1 times the spacing"
std::string text_of(const ThickNoise& noise);

/// The noise of a cloud of which the neighbourhoods of a few points are balls, and those of more
/// (3,072 at most) become flat, as one layer of points does whose heights are normally distributed:
/// not the two sides of a wall, nor plants. None if it is less than .9 spacings, or uneven.
///
/// Judged by 500 points. `curve` is the spatial::curve_order() of the positions.
std::optional<ThickNoise> find_thick_noise(std::span<const Vec3> positions,
                                           std::span<const std::uint32_t> curve);

}  // namespace pcednet::detect
