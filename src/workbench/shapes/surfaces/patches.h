#pragma once

#include <Eigen/Core>
#include <vector>

#include "workbench/shapes/surfaces/shape.h"

namespace pcednet::shapes {

using Vec2 = Eigen::Vector2d;

/// The parallelogram origin + u along + v across; its normal is that of along x across.
SurfacePatch parallelogram(const Vec3& origin, const Vec3& along, const Vec3& across);

/// The triangle a, b, c; counter-clockwise seen from outside.
SurfacePatch triangle(const Vec3& a, const Vec3& b, const Vec3& c);

/// The inside of a simple polygon in the plane origin + x a + y b, (a, b) orthonormal; its normal
/// is a x b.
SurfacePatch polygon(std::vector<Vec2> outline, const Vec3& origin, const Vec3& a, const Vec3& b);

/// The line from (radius, height) `from` to `to`, revolved about the z axis from angle 0 to
/// `angle`: a piece of cylinder, cone or disc. The normal is to the right of the line (away from
/// the axis when the line goes up).
SurfacePatch revolved_line(const Vec2& from, const Vec2& to, double angle);

/// The arc (radius, height) = centre + size (cos t, sin t), t from `start` to `end`, revolved about
/// the z axis by `angle`: a piece of torus, or of sphere. The normal is away from the arc's centre
/// if start < end, else towards it.
SurfacePatch revolved_arc(const Vec2& centre, double size, double start, double end, double angle);

/// A strip of a cylinder of radius `size` about the line from `a` to `b`, from the unit
/// direction `x` to `angle` towards (b - a) x x. The normal points away from the line.
SurfacePatch cylinder_strip(const Vec3& a, const Vec3& b, const Vec3& x, double size, double angle);

/// z = height(x, y) over a rectangle, with its gradient; the normal points up.
/// `max_slope` bounds the length of the gradient.
struct HeightField {
  std::function<double(double x, double y)> height;
  std::function<Vec2(double x, double y)> gradient;
  double max_slope;
};
SurfacePatch graph(const HeightField& field, const Vec2& low, const Vec2& high);

/// The full circle of `radius` about the z axis at `height`.
EdgeCurve circle(double radius, double height, EdgeClass strength = kSharpEdge);

}  // namespace pcednet::shapes
