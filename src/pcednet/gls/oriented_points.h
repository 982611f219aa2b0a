#pragma once

#include <cstdint>
#include <limits>
#include <span>
#include <vector>

#include "pcednet/cloud/point_cloud.h"
#include "pcednet/core/vec3.h"
#include "pcednet/gls/pyramid_plan.h"
#include "pcednet/gls/scale_space_options.h"

namespace pcednet::gls {

/// Points and their normals, which must be of unit length; a normal that is zero or not finite is
/// unusable.
struct OrientedPoints {
  std::span<const Vec3> positions;
  std::span<const Vec3> normals;
  std::span<const std::uint32_t> curve = {};  ///< spatial::curve_order() of the positions, if known
  const PyramidPlan* whole =
      nullptr;  ///< the plan of the cloud that they are part of; fast engine only
};

/// Throws Error(kUsage) for options out of range, arrays of different sizes, and usable normals not
/// of unit length (to 1e-3).
void check(OrientedPoints points, const ScaleSpaceOptions& options);

/// The finite points by position along a curve and, at one position, by normal: results computed in
/// this order do not depend on the numbering.
struct PointOrder {
  std::vector<std::uint32_t> order;
  bool shares_places;  ///< some points lie in one place
};

PointOrder point_order(OrientedPoints points);

/// The place of a point that is not in an order.
inline constexpr std::uint32_t kNowhere = std::numeric_limits<std::uint32_t>::max();

/// The place of each of `count` points in `order`.
std::vector<std::uint32_t> places_in(std::span<const std::uint32_t> order, std::size_t count);

/// The points without copies: of those with equal position and normal the first in the order.
std::vector<std::uint32_t> distinct_points(OrientedPoints points, const PointOrder& order);

/// Gives copies of the points in `distinct` their places, and puts them after them in `order`, that
/// of point_order().
void add_copies(OrientedPoints points, std::span<const std::uint32_t> distinct,
                std::vector<std::uint32_t>& order, std::span<std::uint32_t> places);

/// A requested row of a matrix, and the place of the point it describes.
struct Visit {
  std::uint32_t place;
  std::size_t row;
};

/// The rows to fill for the points numbered `targets`, by place, so that neighbours follow each
/// other; points at kNowhere come last. Throws Error(kUsage) for a number without a point.
std::vector<Visit> plan_visits(std::span<const std::uint32_t> targets,
                               std::span<const std::uint32_t> places);

/// Throws Error(kUsage) unless there is room for exactly `targets` rows of `scales` times `width`
/// features and `scales` statuses.
void check_room(std::size_t targets, std::size_t scales, std::size_t width, std::size_t features,
                std::size_t statuses);

}  // namespace pcednet::gls
