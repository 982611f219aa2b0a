#pragma once

#include <Eigen/Core>
#include <optional>
#include <span>
#include <vector>

#include "pcednet/lines/curves/support_line.h"

namespace pcednet::lines {

/// The four sides of a rectangular opening, in the order of its outline.
///
/// It is the largest rectangle about the middle of the outline without a point in it, where it
/// costs less than `cost`, that of the parts, see straight_parts(): its position, size and
/// direction are fewer numbers than four lines have, and still fewer for one of these directions
/// (unit). Then `outline`, a loop whose last point is its first, begins with the first side.
/// Nothing for the outline of a whole face, and for one of many points: chance adds no side to it.
std::optional<std::vector<SupportLine>> rectangular_opening(
    std::vector<Eigen::Vector2d>& outline, double cost, std::span<const Eigen::Vector2d> directions,
    double spacing);

}  // namespace pcednet::lines
