#pragma once

#include <Eigen/Core>
#include <cstddef>
#include <span>
#include <vector>

#include "pcednet/lines/curves/support_line.h"

namespace pcednet::lines {

/// A circle through consecutive straight parts, with no point of the outline beyond it.
struct SupportArc {
  std::vector<Eigen::Vector2d> points;  ///< of the outline, in its order
  Eigen::Vector2d centre;
  double radius;
  bool hollow;         ///< the interior is outside the circle
  bool closed;         ///< a whole outline
  double empty = 0.0;  ///< area between arc and outline, in squared spacings

  double length() const;
};

inline constexpr double kArcPrice = 1.5 * kLinePrice;

/// Moves straight parts out of `lines` into arcs: four or more in a row, of one turning sense, that
/// a circle explains about as well as they do, which are more. Parts that end where the first one
/// begins are a loop. Polygons less than eight spacings wide are hardly told from circles.
std::vector<SupportArc> take_round_parts(std::vector<SupportLine>& lines,
                                         std::span<const Eigen::Vector2d> outline, double spacing);

/// Drops the parts that cut off a corner of an opening: a disc that rolls around the points, of
/// this radius, cannot enter it. Beyond a true chamfer are points, up to the corner of the parts
/// beside it. `points` are all those of the face.
void drop_cut_corners(std::vector<SupportLine>& lines, std::span<const Eigen::Vector2d> outline,
                      std::span<const Eigen::Vector2d> points, double disc, double spacing);

}  // namespace pcednet::lines
