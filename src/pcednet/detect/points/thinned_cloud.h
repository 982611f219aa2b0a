#pragma once

#include <cstdint>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "pcednet/core/progress.h"
#include "pcednet/detect/points/prepare.h"
#include "pcednet/detect/points/thick_noise.h"

namespace pcednet::detect {

/// Fewer points in place of a cloud's, with less noise: no scale near the spacing shows an edge
/// through noise that is thicker than the spacing.
struct ThinnedCloud {
  ThickNoise noise = {};  ///< as found
  Averaging averaging;
  std::vector<Vec3> positions;            ///< one for each voxel with points
  std::vector<std::uint32_t> average_of;  ///< of each point, see PreparedCloud
};

/// Thins a cloud with thick noise, see find_thick_noise(); nothing if it has none, or if fewer than
/// 4,000 points would be left. Points are grouped by voxels of 2.4 deviations, and a group becomes
/// the mean of the points within 2.5 deviations of its own mean, and then of those around that. The
/// voxels lie about the median of the points: the result follows the cloud to another origin and
/// does not depend on the points' order. `curve` is the spatial::curve_order() of the positions.
/// Throws Error(kCancelled) when `progress` asks to cancel.
std::optional<ThinnedCloud> thin_noise(std::span<const Vec3> positions,
                                       std::span<const std::uint32_t> curve,
                                       const Progress* progress = nullptr);

/// The same as decided for the cloud that these are part of, without its noise.
ThinnedCloud thin_as_decided(std::span<const Vec3> positions, std::span<const std::uint32_t> curve,
                             const Averaging& averaging, const Progress* progress = nullptr);

/// For the user: "noise is 2.1 times the spacing: 500000 points are averaged to 60000".
std::string note_on(const ThinnedCloud& thinned);

}  // namespace pcednet::detect
