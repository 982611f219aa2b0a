#pragma once

#include <cstddef>
#include <optional>

#include "pcednet/lines/local_planes.h"

namespace pcednet::lines {

/// Two half-planes that meet in a line; lengths in spacings.
struct HalfPlanes {
  LocalPlane a, b;
  Vec3 at;              ///< the point of their line nearest to the origin
  Vec3 along;           ///< unit
  Vec3 side_a, side_b;  ///< unit, orthogonal to `along`: in each plane, away from the line
};

/// The half-planes that explain the nearest `count` points, which have noise of standard deviation
/// `noise` (in spacings); nothing if none do, or if a smooth surface explains them better.
///
/// Planes of some of the points, as find_planes() fits them, need normals; in noise these are means
/// over an area that reaches across the edge. Here all points count: they are cut along lines of
/// several directions, each part gets its plane by least squares, and the best cut is improved with
/// each point on the nearer half-plane.
std::optional<HalfPlanes> fit_half_planes(const NearPoints& points, std::size_t count,
                                          double noise);

}  // namespace pcednet::lines
