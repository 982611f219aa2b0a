#pragma once

#include <Eigen/Core>
#include <span>

#include "pcednet/lines/curves/chain.h"
#include "pcednet/lines/curves/curve.h"

namespace pcednet::lines {

/// A line or a circle through nodes.
struct Fit {
  CurveKind kind = CurveKind::kPolyline;  ///< kSegment, kArc, or kPolyline: neither fits
  Vec3 point = Vec3::Zero();              ///< of the line; the centre of the circle
  Vec3 direction = Vec3::UnitX();         ///< of the line; the axis of the circle; unit
  double radius = 0.0;
  double error = 0.0;  ///< root mean square distance of the nodes, in spacings
};

Fit fit_segment(std::span<const ChainNode> nodes);

/// kPolyline if no circle fits the places; the axis is such that they run counter-clockwise.
Fit fit_arc(std::span<const Vec3> places, double spacing);
Fit fit_arc(std::span<const ChainNode> nodes);

/// The distance of `place` from the axis of the circle (x), and its height along it (y).
Eigen::Vector2d about_axis(const Fit& circle, const Vec3& place);

/// The angle of `place` about the axis of the circle, from `x`, which is unit and orthogonal to it.
double angle_at(const Fit& circle, const Vec3& x, const Vec3& place);

/// The point of the unbounded line or circle that is nearest to `place`.
Vec3 nearest_on(const Fit& fit, const Vec3& place);

/// The direction there, unit; counter-clockwise about the axis on a circle.
Vec3 tangent_at(const Fit& fit, const Vec3& place);

}  // namespace pcednet::lines
