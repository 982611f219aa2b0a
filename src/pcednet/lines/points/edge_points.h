#pragma once

#include <cstdint>
#include <span>

#include "pcednet/core/vec3.h"

namespace pcednet::lines {

/// The points and their attributes, in any order. The spans have equal length but for `curve`; the
/// probabilities may be empty.
struct EdgePoints {
  std::span<const Vec3> positions;
  /// Unit, or (0,0,0). Signs, in or out, do not matter, but where those of neighbours agree they
  /// tell the sides of thin walls apart in noise.
  std::span<const Vec3> normals;
  std::span<const std::uint8_t> classes;  ///< EdgeClass
  /// Where the class contradicts both together, as after a correction, it counts alone: a non-edge
  /// beyond one half, an edge below a tenth.
  std::span<const float> p_sharp = {};
  std::span<const float> p_smooth = {};
  /// Not 0 where points around it are missing: no boundary is found there. May be empty.
  std::span<const std::uint8_t> partial = {};
  /// Where the scanner that saw the point stood, NaN where unknown: the ends of what other things
  /// hide from it are no boundaries. May be empty.
  std::span<const Vec3> scanners = {};
  /// As in detect::PreparedCloud, of all points with a finite position; empty if not known.
  std::span<const std::uint32_t> curve = {};
};

}  // namespace pcednet::lines
