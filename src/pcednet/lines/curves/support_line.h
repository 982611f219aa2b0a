#pragma once

#include <Eigen/Core>
#include <optional>
#include <span>
#include <vector>

namespace pcednet::lines {

/// Points first to last of an outline and the line through them, `normal` . p = `offset`, with no
/// point beyond it.
struct SupportLine {
  std::size_t first, last;
  Eigen::Vector2d normal;  ///< unit, outward
  double offset;
  double empty = 0.0;        ///< area between line and outline, in squared spacings
  double to_corner[2] = {};  ///< from its first and last point to corners that the outline cuts off

  Eigen::Vector2d along() const { return {-normal.y(), normal.x()}; }
};

/// The upper side of the convex hull of some points, by x.
std::vector<Eigen::Vector2d> outer_hull(std::vector<Eigen::Vector2d> points);

inline constexpr double kLinePrice = 8.0;

/// The straight parts of an outline, in its order; the interior is on the left of consecutive
/// points. They minimise
///
///     sum over lines of (a price + points that the empty area between line and outline would hold)
///
/// which is the negative logarithm of the probability of such an outline if points are drawn at
/// random: `spacing` squared is the area per point. Then parts become one that differ by less than
/// noise (in spacings) explains: the last points along a line are as far out as it is long.
std::vector<SupportLine> straight_parts(std::span<const Eigen::Vector2d> outline, double spacing,
                                        double noise);

/// The line of the same points with another direction, if the outline is consistent with it.
std::optional<SupportLine> turned(const SupportLine& line, const Eigen::Vector2d& normal,
                                  std::span<const Eigen::Vector2d> outline, double spacing);

}  // namespace pcednet::lines
