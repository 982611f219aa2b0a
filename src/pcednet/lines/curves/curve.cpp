#include "pcednet/lines/curves/curve.h"

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>

namespace pcednet::lines {
namespace {

/// A circle of more sides than these looks round at any size.
constexpr double kMostSides = 4096.0;

std::vector<Vec3> sampled_arc(const Curve& arc, double tolerance) {
  const double cosine = std::clamp(1.0 - tolerance / arc.radius, 0.0, 1.0);
  const double largest_step =
      std::clamp(2.0 * std::acos(cosine), kWholeTurn / kMostSides, kWholeTurn / 8.0);
  const double angle = angle_of(arc);
  const auto steps = static_cast<std::size_t>(std::ceil(angle / largest_step));
  const Vec3 x = arc.points.front() - arc.centre;
  const Vec3 y = arc.axis.cross(x);
  std::vector<Vec3> vertices = {arc.points.front()};
  for (std::size_t i = 1; i < steps; ++i) {
    const double t = angle * static_cast<double>(i) / static_cast<double>(steps);
    vertices.push_back(arc.centre + std::cos(t) * x + std::sin(t) * y);
  }
  vertices.push_back(arc.points.back());
  return vertices;
}

}  // namespace

const char* name_of(CurveKind kind) {
  switch (kind) {
    case CurveKind::kSegment:
      return "segment";
    case CurveKind::kArc:
      return "arc";
    case CurveKind::kCircle:
      return "circle";
    case CurveKind::kPolyline:
      break;
  }
  return "polyline";
}

double turn_about(const Vec3& axis, const Vec3& from, const Vec3& to) {
  const double angle = std::atan2(axis.dot(from.cross(to)), from.dot(to));
  return angle > 0.0 ? angle : angle + kWholeTurn;
}

double angle_of(const Curve& curve) {
  if (curve.kind == CurveKind::kCircle) return kWholeTurn;
  return turn_about(curve.axis, curve.points.front() - curve.centre,
                    curve.points.back() - curve.centre);
}

double length_of(const Curve& curve) {
  if (curve.kind == CurveKind::kArc || curve.kind == CurveKind::kCircle) {
    return curve.radius * angle_of(curve);
  }
  double length = 0.0;
  for (std::size_t i = 1; i < curve.points.size(); ++i) {
    length += (curve.points[i] - curve.points[i - 1]).norm();
  }
  if (curve.closed) length += (curve.points.front() - curve.points.back()).norm();
  return length;
}

std::vector<Vec3> sampled(const Curve& curve, double tolerance) {
  if (curve.kind == CurveKind::kArc || curve.kind == CurveKind::kCircle) {
    return sampled_arc(curve, tolerance);
  }
  std::vector<Vec3> vertices = curve.points;
  if (curve.closed) vertices.push_back(vertices.front());
  return vertices;
}

}  // namespace pcednet::lines
