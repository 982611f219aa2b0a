#pragma once

#include <Eigen/Geometry>
#include <cmath>
#include <vector>

#include "pcednet/lines/curves/curve.h"

namespace pcednet::io {

inline lines::Curve make_polyline(std::vector<Vec3> points, EdgeClass edge_class,
                                  bool closed = false) {
  lines::Curve curve;
  curve.kind = points.size() == 2 ? lines::CurveKind::kSegment : lines::CurveKind::kPolyline;
  curve.edge_class = edge_class;
  curve.points = std::move(points);
  curve.closed = closed;
  return curve;
}

/// A unit vector across `axis`, at that angle.
inline Vec3 across(const Vec3& axis, double angle) {
  return Eigen::AngleAxisd(angle, axis) * axis.unitOrthogonal();
}

/// From angle `from` on, counter-clockwise about the axis, over `angle`.
inline lines::Curve make_arc(const Vec3& centre, const Vec3& axis, double radius, double from,
                             double angle, EdgeClass edge_class = kSharpEdge) {
  lines::Curve curve;
  curve.kind = lines::CurveKind::kArc;
  curve.edge_class = edge_class;
  curve.centre = centre;
  curve.axis = axis.normalized();
  curve.radius = radius;
  curve.points = {centre + radius * across(curve.axis, from),
                  centre + radius * across(curve.axis, from + angle)};
  return curve;
}

inline lines::Curve make_circle(const Vec3& centre, const Vec3& axis, double radius,
                                EdgeClass edge_class = kSharpEdge) {
  lines::Curve curve = make_arc(centre, axis, radius, 0.3, 1.0, edge_class);
  curve.kind = lines::CurveKind::kCircle;
  curve.closed = true;
  curve.points.resize(1);
  return curve;
}

/// One of each kind and class in a national grid, corners shared.
inline std::vector<lines::Curve> sample_curves() {
  const Vec3 corner(500123.456789, 5400987.654321, 252.1), other(500124.1, 5400988.2, 253.3);
  std::vector<lines::Curve> curves = {
      make_polyline({corner, other}, kSharpEdge),
      make_polyline({other, Vec3(500125.0 / 3.0, 0.1, -0.3), corner}, kSmoothEdge, true),
      make_polyline({corner, Vec3(500120.7, 5400980.1, 250.0), Vec3(500119.3, 5400981.0, 251.5)},
                    kBoundary),
      make_arc(corner, Vec3(1, 2, 3), 2.5, 0.4, 2.0, kSmoothEdge),
      make_circle(other, Vec3(-1, 0.5, -2), 0.75)};
  curves[0].confidence = 0.9375;
  curves[0].dihedral_angle = std::acos(0.0);
  curves[0].support = 123;
  return curves;
}

}  // namespace pcednet::io
