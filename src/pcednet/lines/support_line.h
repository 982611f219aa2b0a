#pragma once

#include <Eigen/Core>
#include <optional>
#include <span>
#include <vector>

namespace pcednet::lines {

/// Points first to last of an outline and the line that they support: `normal` . p = `offset`, no
/// point is beyond it.
struct SupportLine {
  std::size_t first, last;
  Eigen::Vector2d normal;  ///< unit, outward
  double offset;
};

/// The straight parts of an outline, in its order: points follow each other with the inside on
/// their left. Those of least
///
///     sum over lines of (a price + points that the empty area between line and outline would hold)
///
/// which is the negative logarithm of the chance of such an outline of points drawn at random:
/// `spacing` squared is the area of one point.
std::vector<SupportLine> straight_parts(std::span<const Eigen::Vector2d> outline, double spacing);

/// The same points' line of another direction, if the outline does not speak against it.
std::optional<SupportLine> turned(const SupportLine& line, const Eigen::Vector2d& normal,
                                  std::span<const Eigen::Vector2d> outline, double spacing);

}  // namespace pcednet::lines
