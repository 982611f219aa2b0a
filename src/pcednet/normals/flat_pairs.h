#pragma once

#include <cstddef>
#include <cstdint>
#include <span>
#include <utility>
#include <vector>

#include "pcednet/core/vec3.h"

namespace pcednet::normals {

/// Neighbours on one flat piece of surface, judged by their positions and unsigned normals.
/// Opposite normals of such a pair mean wrong signs or the two sides of a wall hardly thicker than
/// the spacing.
///
/// Up to 20,000 points, evenly spread along the curve, are paired with those of their 12 nearest
/// neighbours whose normal is within 26 degrees of parallel (|n_i.n_j| > 0.9) and whose direction e
/// is within 17 degrees of the surface (|e.n_i| < 0.3), if these are more than half; on leaves and
/// noise they almost never are. On clean oriented clouds fewer than one such pair in 1000 opposes;
/// with a tenth of the signs wrong, 18 in 100; where two patches of opposite signs meet, the pairs
/// across the border.
class FlatPairs {
 public:
  /// One normal per position, of unit length; points whose normal is zero or not finite are left
  /// out. `curve` is the spatial::curve_order() of the positions.
  FlatPairs(std::span<const Vec3> positions, std::span<const Vec3> normals,
            std::span<const std::uint32_t> curve);

  std::size_t size() const { return pairs_.size(); }

  /// The number of pairs with opposite normals.
  std::size_t opposed(std::span<const Vec3> normals) const;

  /// Whether opposed normals belong to the two sides of walls, from 0 to 1: across a wall each
  /// point lies behind the other (or in front, with inward normals), while pairs with wrong signs
  /// show either case equally often. |sum e.n_i| / sum |e.n_i| over the opposed pairs.
  double one_sidedness(std::span<const Vec3> positions, std::span<const Vec3> normals) const;

 private:
  std::vector<std::pair<std::uint32_t, std::uint32_t>> pairs_;
};

}  // namespace pcednet::normals
