#pragma once

#include <cstddef>
#include <optional>
#include <span>
#include <string>

#include "pcednet/core/vec3.h"
#include "pcednet/spatial/neighbour_search.h"

namespace pcednet::normals {

/// How normals are estimated.
struct NeighbourChoice {
  std::size_t neighbours = 12;  ///< that planes are fitted to
  std::size_t fewest = 0;       ///< unless 0, that many where they suffice: see local_counts()
  bool noisy = false;           ///< noise requires more than would show the surface without it
  bool exact_planes = false;    ///< points on plane faces have the normal of exact_normal()
};

/// The number of neighbours in words: "12", or "12 to 48".
std::string number_of(const NeighbourChoice& choice);

/// That many neighbours; nothing for 0, for which choose_neighbours() decides. Throws Error(kUsage)
/// for 1 or fewer than 0.
std::optional<NeighbourChoice> given_neighbours(int neighbours);

/// Whether the points of a noisy cloud have their own numbers of neighbours or one.
enum class Counts { kLocal, kOne };

/// 12 neighbours, more on noisy clouds and on those in lines, and whether the surface consists of
/// plane faces.
///
/// Where scan lines are much farther from each other than their points, the nearest are of one
/// line: the count is doubled while the median width of 2000 points (see PlaneFit) is below 0.1, or
/// the last neighbour is, in the median, 2.5 times as far as that of a quarter of the count. More
/// neighbours increase the relative thickness of the fitted planes where the surface bends and
/// reduce it where it is noise. If they reduce the median thickness and it is above 0.01, or from
/// 0.4 on, where neighbourhoods are balls of noise, the cloud is noisy: each point has 12, 24 or 48
/// neighbours, as local_counts() says; or all, and those of fewer than 4000 points, have the one
/// for which the median is least. Only above 0.01, where planes across edges are the rule, and not
/// where the nearest lie along lines, are exact planes looked for: a sixth of the 2000 points must
/// lie on one, see is_on_face(), which neither noise nor curved surfaces reach. `points` must be
/// distinct and in curve order, and `search` made from them.
NeighbourChoice choose_neighbours(std::span<const Vec3> points,
                                  const spatial::NeighbourSearch& search, Counts counts);

}  // namespace pcednet::normals
