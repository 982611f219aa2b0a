#include "workbench/shapes/curve_fit.h"

#include <Eigen/Geometry>
#include <cmath>

#include "workbench/shapes/shape.h"

namespace pcednet::shapes {
namespace {

using lines::Curve;
using lines::CurveKind;

/// Radius over chord of arcs at most: a flatter curve is only by chance as near to a circle.
constexpr double kFlattest = 100.0;

std::optional<Curve> as_segment(std::span<const Vec3> points) {
  const Segment segment = {points.front(), points.back()};
  for (const Vec3& p : points) {
    if (distance(segment, p) > kExactFit) return std::nullopt;
  }
  Curve curve;
  curve.kind = CurveKind::kSegment;
  curve.points = {segment.a, segment.b};
  return curve;
}

/// The circle through three of the points, if all are on it.
std::optional<Curve> as_arc(std::span<const Vec3> points, bool closed) {
  const std::size_t n = points.size();
  if (n < 3) return std::nullopt;
  const Vec3& a = points[0];
  const Vec3 u = points[closed ? n / 3 : n / 2] - a, v = points[closed ? 2 * n / 3 : n - 1] - a;
  const Vec3 normal = u.cross(v);
  if (!(normal.norm() > 0.0)) return std::nullopt;
  Curve curve;
  curve.kind = closed ? CurveKind::kCircle : CurveKind::kArc;
  curve.closed = closed;
  const Vec3 to_centre =
      (u.squaredNorm() * v - v.squaredNorm() * u).cross(normal) / (2.0 * normal.squaredNorm());
  curve.centre = a + to_centre;
  curve.axis = normal.normalized();
  curve.radius = to_centre.norm();
  if (!(curve.radius < kFlattest * (points[n - 1] - a).norm()) && !closed) return std::nullopt;
  for (const Vec3& p : points) {
    const Vec3 offset = p - curve.centre;
    const double height = offset.dot(curve.axis);
    const double away = (offset - height * curve.axis).norm() - curve.radius;
    if (!(std::hypot(height, away) < kExactFit)) return std::nullopt;
  }
  curve.points = {a};
  if (!closed) curve.points.push_back(points.back());
  return curve;
}

}  // namespace

std::optional<Curve> fit_exact(std::span<const Vec3> points, bool closed) {
  if (!closed) {
    if (auto curve = as_segment(points)) return curve;
  }
  return as_arc(points, closed);
}

}  // namespace pcednet::shapes
