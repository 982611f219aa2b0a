#pragma once

#include <cstddef>
#include <optional>
#include <span>
#include <vector>

#include "pcednet/core/progress.h"
#include "pcednet/core/vec3.h"
#include "pcednet/normals/neighbour_graph.h"

namespace pcednet::normals {

struct OrientOptions {
  int neighbours = 12;  ///< distinct points that each point compares its sign with, at least 1
  std::optional<Vec3> viewpoint = {};  ///< if given, every normal is turned to face it
  bool count_turned = false;           ///< fills in Orientation::turned
};

/// What the signs rest on.
struct Orientation {
  std::size_t components = 0;  ///< connected parts, each oriented by itself; 0 with a viewpoint
  std::size_t undecided = 0;   ///< those that are open sheets: their normals point upwards (+z)
  std::size_t turned = 0;  ///< distinct points turned against the majority of their part, of those
                           ///< whose normals lie along those of most neighbours
};

/// Turns normals about so that neighbours agree and closed surfaces have them outwards.
///
/// Neighbours i, j with e the direction from one to the other vote for equal signs by
///
///     v = n_i.n_j - 1.8 (e.n_i)(e.n_j)
///
/// (negative: for opposite signs), which is between the rule of Hoppe et al. 1992 (factor 0) and
/// the reflection of one normal in the plane half-way (factor 2): the first takes the far side of a
/// thin wall for the near one, the second is easily led astray by noise. The graph is then
/// contracted: every part joins the neighbour that it has the strongest sum of votes with, and the
/// votes between two parts are summed, until no links are left. Single points that their neighbours
/// outvote are turned last.
///
/// A component's normals are then turned outwards: in 48 directions, the part of it farthest out
/// must face that way, on the whole. Where these directions contradict each other (an open sheet)
/// the mean normal is made to point upwards. Every component counts by itself: the inner one of two
/// nested surfaces has its normals outwards, too.
///
/// With a viewpoint every normal is turned to face it, which is right for what one scanner saw.
///
/// `normals` has one vector per position, of unit length or (0,0,0), which stays. The result is the
/// same for any signs before, any number of threads and any order of the points, provided that
/// points at the same position have the same normal up to sign. Throws Error(kUsage) on
/// `neighbours` < 1.
Orientation orient_normals(std::span<const Vec3> positions, std::span<Vec3> normals,
                           const OrientOptions& options = {}, const Progress* progress = nullptr);

/// The same on a graph made from the positions; of options.neighbours it uses as many as it has.
Orientation orient_normals(const NeighbourGraph& graph, std::span<const Vec3> positions,
                           std::span<Vec3> normals, const OrientOptions& options = {},
                           const Progress* progress = nullptr);

/// The same for the normals of the graph's points.
Orientation orient_points(const NeighbourGraph& graph, std::span<Vec3> normals,
                          const OrientOptions& options, const Progress* progress = nullptr);

/// Turns every normal to face the viewpoint of its position, as in OrientOptions; those whose
/// viewpoint is not finite stay. Returns how many points have one. One viewpoint per position.
std::size_t face_viewpoints(std::span<const Vec3> positions, std::span<Vec3> normals,
                            std::span<const Vec3> viewpoints);

/// Throws Error(kUsage) unless there is one normal per position.
void check_size(std::span<const Vec3> positions, std::span<const Vec3> normals);

}  // namespace pcednet::normals
