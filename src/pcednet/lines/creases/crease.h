#pragma once

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <functional>
#include <numbers>
#include <optional>
#include <span>
#include <vector>

#include "pcednet/cloud/point_cloud.h"
#include "pcednet/core/progress.h"
#include "pcednet/core/vec3.h"
#include "pcednet/lines/points/sampling.h"
#include "pcednet/spatial/kd_tree.h"

namespace pcednet::lines {

class OrderedPoints;

/// The estimate of an edge at one edge point: the line where two planes beside it meet.
struct Crease {
  Vec3 at;               ///< the point of that line nearest to the edge point
  Vec3 along;            ///< unit, its sign arbitrary
  Vec3 side_a, side_b;   ///< unit, orthogonal to `along`: in each plane, away from the line
  double spacing;        ///< of the points around it
  float probability;     ///< that the edge point is on an edge
  float bend = 0.0f;     ///< of the adjacent surfaces into the wedge, in spacings; 0: plane
  EdgeClass edge_class;  ///< of the edge point
  bool rounded = false;  ///< a smooth surface explains the points better than two planes
};

/// The angle, in radians, between the normals of two surfaces that leave their edge in these
/// directions.
inline double dihedral_angle(const Vec3& side_a, const Vec3& side_b) {
  return std::numbers::pi - std::acos(std::clamp(side_a.dot(side_b), -1.0, 1.0));
}

/// The crease of a point, from its nearest others; none if there is none.
using CreaseAt = std::function<std::optional<Crease>(std::uint32_t point,
                                                     std::span<const spatial::Neighbour> others)>;

/// The results of crease_at() at `points` (ascending), from `count` others of each.
std::vector<std::optional<Crease>> creases_at(const OrderedPoints& cloud,
                                              std::span<const std::uint32_t> points,
                                              std::size_t count, Stage& stage,
                                              const CreaseAt& crease_at);

/// Appends those that there are.
void append_found(std::span<const std::optional<Crease>> found, std::vector<Crease>& creases);

/// The creases of the edge points; an edge point without two planes beside it has none. In measured
/// points with little noise some are rounded.
std::vector<Crease> find_creases(const OrderedPoints& cloud, const Sampling& sampling,
                                 const Progress* progress);

}  // namespace pcednet::lines
