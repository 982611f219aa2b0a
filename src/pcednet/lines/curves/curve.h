#pragma once

#include <cstddef>
#include <cstdint>
#include <numbers>
#include <vector>

#include "pcednet/cloud/point_cloud.h"
#include "pcednet/core/vec3.h"

namespace pcednet::lines {

/// The angle of a circle.
inline constexpr double kWholeTurn = 2.0 * std::numbers::pi;

enum class CurveKind : std::uint8_t { kSegment, kArc, kCircle, kPolyline };

/// An edge as a curve, in the unit and coordinates of its cloud.
struct Curve {
  CurveKind kind = CurveKind::kPolyline;
  EdgeClass edge_class = kSharpEdge;

  /// Segment and arc: both ends. Circle: one point on it. Polyline: its vertices, two or more; the
  /// first is not repeated at the end of a closed one.
  std::vector<Vec3> points = {};
  bool closed = false;  ///< a circle, or a polyline that returns to its first vertex

  // Arcs and circles run counter-clockwise about the axis.
  Vec3 centre = Vec3::Zero();
  Vec3 axis = Vec3::UnitZ();  ///< unit
  double radius = 0.0;

  double confidence = 0.0;      ///< mean probability that its edge points are on an edge, 0 to 1
  double dihedral_angle = 0.0;  ///< mean angle between the surfaces' normals, radians; 0: flat
  std::size_t support = 0;      ///< edge points that it represents
  bool exact = false;           ///< where exact surfaces meet
};

/// "segment", "arc", "circle" or "polyline".
const char* name_of(CurveKind kind);

/// The angle from `from` to `to` counter-clockwise about `axis`, to which they are orthogonal, in
/// (0, 2 pi].
double turn_about(const Vec3& axis, const Vec3& from, const Vec3& to);

/// The angle that an arc or a circle spans, in (0, 2 pi].
double angle_of(const Curve& curve);

double length_of(const Curve& curve);

/// Vertices of a polyline that is nowhere farther from the curve than `tolerance`, which must be
/// positive, or than 3e-7 of the radius: a circle has 4096 sides at most. Ends are exact. The first
/// vertex is repeated at the end of a closed curve.
std::vector<Vec3> sampled(const Curve& curve, double tolerance);

}  // namespace pcednet::lines
