#pragma once

#include <cstddef>
#include <optional>
#include <span>
#include <string_view>
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

/// A summary of the orientation.
struct Orientation {
  std::size_t components = 0;  ///< connected parts, each oriented separately; 0 with a viewpoint
  std::size_t undecided = 0;   ///< open sheets among them: their normals point upwards (+z)
  std::size_t turned = 0;  ///< distinct points flipped against the majority of their part, among
                           ///< those whose normals are nearly parallel to those of most neighbours
};

/// Flips normals so that neighbours agree and those of closed surfaces point outwards.
///
/// Neighbours i, j with e the direction from one to the other vote for equal signs by
///
///     v = n_i.n_j - 1.8 (e.n_i)(e.n_j)
///
/// (negative: for opposite signs), which is between the rule of Hoppe et al. 1992 (factor 0) and
/// the reflection of one normal in the bisecting plane (factor 2): the first confuses the two sides
/// of a thin wall, the second is sensitive to noise. The graph is then contracted: every part joins
/// the neighbour with the largest sum of votes, and the votes between two parts are summed, until
/// no links are left. Single points that their neighbours outvote are flipped last.
///
/// The normals of a component are then oriented outwards by outwardness(). If that is undecided (an
/// open sheet), the mean normal points upwards. Every component is oriented separately: the normals
/// of the inner one of two nested surfaces point outwards, too.
///
/// With a viewpoint every normal faces it, which is right for a single scan.
///
/// `normals` has one vector per position, of unit length or (0,0,0), which stays. The result is the
/// same for any input signs, any number of threads and any order of the points, provided that
/// points at the same position have the same normal up to sign. Throws Error(kUsage) on
/// `neighbours` < 1.
Orientation orient_normals(std::span<const Vec3> positions, std::span<Vec3> normals,
                           const OrientOptions& options = {}, const Progress* progress = nullptr);

/// The same on a graph made from the positions; uses at most its degree of options.neighbours.
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

/// The same for scanners, but for normals that are seen at a slant (a cosine below .7): these are
/// turned where their neighbours oppose them, the more the better these are seen. Near an edge
/// normals are between those of both faces, one of which may be hidden, and which of their sides is
/// seen says little.
std::size_t face_scanners(std::span<const Vec3> positions, std::span<Vec3> normals,
                          std::span<const Vec3> scanners);

/// Throws Error(kUsage) unless there are as many of `what` ("normals") as positions.
void check_size(std::string_view what, std::size_t count, std::size_t positions);

}  // namespace pcednet::normals
