#include "pcednet/lines/curves/touch.h"

#include <cmath>

#include "pcednet/core/half_space.h"

namespace pcednet::lines {
namespace {

constexpr double kLeastTouch = 0.35;  ///< of two centres, in the larger radius

/// The place of `circle` in the direction of `out` from its centre.
Vec3 place_towards(const Fit& circle, const Vec3& out) {
  return circle.point + circle.radius * out;
}

/// The place on circle `a` that is on the line through both centres, on the side of `place`.
std::optional<Vec3> on_centre_line(const Fit& a, const Fit& b, const Vec3& place) {
  const Vec3 between = b.point - a.point;
  const double apart = between.norm();
  if (apart < kLeastTouch * std::max(a.radius, b.radius)) return std::nullopt;
  const Vec3 out = between / apart;
  return place_towards(a, turned_to(out, place - a.point));
}

}  // namespace

std::optional<Vec3> touching_place(const Fit& a, const Fit& b, const Vec3& place, double within) {
  if (a.kind == CurveKind::kPolyline || b.kind == CurveKind::kPolyline) return std::nullopt;
  if (a.kind == CurveKind::kSegment && b.kind == CurveKind::kSegment) return std::nullopt;
  if (b.kind == CurveKind::kSegment) return touching_place(b, a, place, within);
  std::optional<Vec3> first =
      a.kind == CurveKind::kSegment ? nearest_on(a, b.point) : on_centre_line(a, b, place);
  if (!first) return std::nullopt;
  const Vec3 second = nearest_on(b, *first);
  if (!((second - *first).norm() < within)) return std::nullopt;
  if (std::abs(tangent_at(a, *first).dot(tangent_at(b, second))) < kTouching) return std::nullopt;
  return 0.5 * (*first + second);
}

}  // namespace pcednet::lines
