#pragma once

#include <array>
#include <cstdint>
#include <map>
#include <optional>
#include <vector>

#include "pcednet/lines/ordered_points.h"
#include "pcednet/spatial/kd_tree.h"

namespace pcednet::lines {

/// The points of each scanner that is known and saw hundreds, by the direction in which it saw
/// them.
class Shadows {
 public:
  explicit Shadows(const OrderedPoints& cloud);

  /// Whether the surface at `point` ends in the direction `outward` only because its scanner does
  /// not see the rest: three or more of the 28 beams around that of the point end there, six
  /// spacings or more before it; or there are no beams, as in the cone below a scanner that turns,
  /// where its tripod stands, and above it.
  bool hide_what_is_beyond(std::size_t point, const Vec3& outward, double spacing) const;

 private:
  struct View {
    std::vector<std::uint32_t> points;  ///< ascending
    spatial::KdTree beams;              ///< unit, of the points
    /// Radians below and above the horizon from which it has no beams.
    std::optional<double> lowest, highest;

    /// Whether it has none in the direction `beside` of this one, `step` away.
    bool ends(const Vec3& beam, const Vec3& beside, double step) const;
  };

  const OrderedPoints& cloud_;
  std::map<std::array<double, 3>, View> views_;  ///< by the scanner's place
};

}  // namespace pcednet::lines
