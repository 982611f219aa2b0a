#pragma once

#include <functional>
#include <span>
#include <vector>

#include "pcednet/core/progress.h"
#include "pcednet/detect/points/prepare.h"

namespace pcednet::detect {

// The steps of prepare() that choose and move points.

/// The parts of a cloud that are used.
struct Points {
  std::span<const Vec3> positions;
  std::span<const Vec3> normals;                ///< may be empty
  std::function<std::vector<Vec3>()> scanners;  ///< of every point, or of none
  std::span<const Vec3> estimates = {};         ///< whose signs new ones take; may be empty

  std::size_t size() const { return positions.size(); }
  bool empty() const { return positions.empty(); }
  bool has_normals() const { return !normals.empty(); }
};

/// Puts the points with a position in order, without those so far out that they have none. Throws
/// Error(kInsufficient) if there is none.
void order_finite_points(PreparedCloud& prepared);

/// Puts averages in place of points in thick noise, otherwise leaves out crowds at the poles of
/// scanners; the points that are used then.
Points fewer_points(const Points& cloud, PreparedCloud& prepared, const Progress* progress);

/// Spreads positions that are rounded.
void spread_positions(const Rounding& rounding, PreparedCloud& prepared);

/// The last two by the decision of `prepared`, which was made for the cloud that this is part of.
Points points_as_decided(const Points& cloud, PreparedCloud& prepared, const Progress* progress);

}  // namespace pcednet::detect
