#pragma once

#include <cstddef>
#include <cstdint>
#include <span>
#include <string>
#include <vector>

#include "pcednet/core/progress.h"
#include "pcednet/core/vec3.h"

namespace pcednet::detect {

// The rows of a scanner meet above and below it. Near these poles the points of a row are far
// nearer to each other than to the next row and, in noise, look like a strip along the beams: their
// normals are wrong, and each row seems to have a rim.

/// Fewer points in place of a cloud's, without the crowds at the poles of scanners.
struct WithoutPoles {
  std::vector<std::uint32_t> kept;        ///< the points that stay, in their order
  std::vector<std::uint32_t> average_of;  ///< of each point, see PreparedCloud
  std::size_t crowded;                    ///< points that are not kept

  /// Whether these are a hundredth of the points, and so matter.
  bool are_many() const;
};

/// Leaves out points more than 60 degrees above or below their scanner whose beam is nearer than
/// half the angle between its rows to that of a point that is kept and has four or more so near.
/// `scanners` has one for each point, NaN where unknown; `curve` is the spatial::curve_order() of
/// the positions. The result does not depend on the points' order. Throws Error(kCancelled) when
/// `progress` asks to cancel.
WithoutPoles without_poles(std::span<const Vec3> positions, std::span<const Vec3> scanners,
                           std::span<const std::uint32_t> curve,
                           const Progress* progress = nullptr);

/// For the user.
std::string note_on(const WithoutPoles& thinned);

}  // namespace pcednet::detect
