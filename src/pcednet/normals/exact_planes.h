#pragma once

#include <cstddef>
#include <cstdint>
#include <span>

#include "pcednet/core/vec3.h"

namespace pcednet::normals {

/// The neighbours of a point among which exact_normal() looks for planes.
inline constexpr std::size_t kExactNeighbours = 16;

/// Whether points are spread over a plane, rather than along a line, about a place: at least a
/// quarter as wide as long, as standard deviations. Those of a scan line or an edge are not: they
/// lie on many planes, or exactly on the one that the scanner's beam sweeps. `products` is the sum
/// of v v^T of their offsets v from the place.
bool fill_a_plane(const Mat3& products);

/// The unit normal of the plane face that a point lies on, of any sign, or zero if it lies on none.
///
/// Points drawn from a CAD part without noise lie exactly on its faces. A face is a plane through
/// the point with at least 5 of its 16 nearest neighbours, not collinear, nearer to it than 0.003
/// of the distance to the last: such planes hardly occur by chance. The plane with most neighbours
/// counts, near ones with more weight; it is refitted to them. If a second plane, turned by more
/// than 25 degrees, has 3 neighbours that are not on the first, the point lies on the edge of both,
/// and the result is the mean of their normals, to the side on which the faces meet.
///
/// `neighbours` are nearest first.
Vec3 exact_normal(std::span<const Vec3> points, std::size_t point,
                  std::span<const std::uint32_t> neighbours);

/// Whether the point lies on such a plane whose neighbours off it are all on one side. They are
/// where the plane is a face; the surface crosses the planes that a scanner's beam sweeps, and
/// those through rows of points on a grid.
bool is_on_face(std::span<const Vec3> points, std::size_t point,
                std::span<const std::uint32_t> neighbours);

/// The normal of the first of these planes alone, for any `tolerance` in place of 0.003: of one
/// face even where the point is near its edge.
Vec3 face_normal(std::span<const Vec3> points, std::size_t point,
                 std::span<const std::uint32_t> neighbours, double tolerance);

}  // namespace pcednet::normals
