#pragma once

#include <cstddef>
#include <optional>
#include <span>

#include "pcednet/core/vec3.h"
#include "pcednet/spatial/neighbour_search.h"

namespace pcednet::normals {

/// How normals are estimated.
struct NeighbourChoice {
  std::size_t neighbours = 12;  ///< that planes are fitted to
  bool noisy = false;           ///< noise requires more than would show the surface without it
  bool exact_planes = false;    ///< points on plane faces have the normal of exact_normal()
};

/// That many neighbours; nothing for 0, for which choose_neighbours() decides. Throws Error(kUsage)
/// for 1 or fewer than 0.
std::optional<NeighbourChoice> given_neighbours(int neighbours);

/// 12 neighbours, or 24 or 48 on noisy clouds and on those in lines, and whether the surface
/// consists of plane faces.
///
/// Where scan lines are much farther from each other than their points, the nearest are of one
/// line: the count is doubled while the median width of 2000 points (see PlaneFit) is below 0.1.
/// Twice the neighbours increase the relative thickness of the fitted planes where the surface
/// bends and reduce it where it is noise. From there on, the count is therefore doubled as long as
/// the median thickness falls, the first time only if it is above 0.01. From 0.4
/// on, neighbourhoods are balls of noise, and 48 are taken. Only above 0.01, where planes across
/// edges are the rule, are exact planes looked for: a sixth of the 2000 points must lie on one, see
/// is_on_face(), which neither noise nor curved surfaces reach. `points` must be distinct and in
/// curve order, and `search` made from them.
NeighbourChoice choose_neighbours(std::span<const Vec3> points,
                                  const spatial::NeighbourSearch& search);

}  // namespace pcednet::normals
