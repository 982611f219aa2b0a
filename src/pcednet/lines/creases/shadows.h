#pragma once

#include <array>
#include <cstdint>
#include <map>
#include <optional>
#include <span>
#include <vector>

#include "pcednet/lines/points/ordered_points.h"
#include "pcednet/spatial/kd_tree.h"

namespace pcednet::lines {

/// The points of each scanner that is known and saw hundreds, by the direction in which it saw
/// them.
class Shadows {
 public:
  explicit Shadows(const OrderedPoints& cloud);

  /// Whether the surface at `point` ends in the direction `outward` only because its scanner does
  /// not see the rest: beams beside that of the point end before it; the surface turns away, as
  /// that of a column; or there are no beams, as in the cone below a scanner that turns, where its
  /// tripod stands, and above it.
  bool are_why_it_ends(std::size_t point, const Vec3& outward, double spacing) const;

 private:
  struct View {
    std::vector<std::uint32_t> points;  ///< ascending
    spatial::KdTree beams;              ///< unit, of the points
    /// Radians below and above the horizon from which it has no beams.
    std::optional<double> lowest, highest;

    /// Whether it has none in the direction `beside` of this one, `step` away.
    bool ends(const Vec3& beam, const Vec3& beside, double step) const;
  };

  // Of the points of a view beside a point, whose surface ends.

  /// Whether the surface meets the beams of those inside ever less aslant, without a sharp edge.
  bool turns_away(std::size_t point, const View& view, std::span<const std::uint32_t> inside) const;
  /// Whether the beams beyond end six spacings or more before the point.
  bool lies_in_shadow(std::size_t point, const View& view, std::span<const std::uint32_t> beyond,
                      double spacing) const;

  const OrderedPoints& cloud_;
  std::map<std::array<double, 3>, View> views_;  ///< by the scanner's place
};

}  // namespace pcednet::lines
