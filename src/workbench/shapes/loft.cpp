#include "workbench/shapes/loft.h"

#include <algorithm>
#include <cmath>

namespace pcednet::shapes {
namespace {

/// Corner `k` of the outline after `u` of the turn.
Vec2 corner(const Loft& loft, std::size_t k, double u) {
  const std::size_t i = k % loft.first.size();
  return (1.0 - u) * loft.first[i] + u * loft.last[i];
}

Vec3 turned(const Vec2& p, double angle) {
  return {p.x() * std::cos(angle), p.x() * std::sin(angle), p.y()};
}

/// The surface swept by the side from corner k to the next.
SurfacePoint strip_point(const Loft& loft, std::size_t k, double u, double v) {
  const Vec2 a = corner(loft, k, u);
  const Vec2 b = corner(loft, k + 1, u);
  const Vec2 p = (1.0 - v) * a + v * b;
  const std::size_t i = k % loft.first.size();
  const std::size_t j = (k + 1) % loft.first.size();
  const Vec2 change =
      (1.0 - v) * (loft.last[i] - loft.first[i]) + v * (loft.last[j] - loft.first[j]);
  const double t = u * loft.angle;
  const Vec3 tangent(-std::sin(t), std::cos(t), 0.0);
  const Vec3 along_turn = turned(change, t) + loft.angle * p.x() * tangent;
  const Vec3 along_side = turned(b - a, t);
  const Vec3 cross = along_turn.cross(along_side);
  const double density = cross.norm();
  return {turned(p, t), cross / density, density};
}

SurfacePatch strip(const Loft& loft, std::size_t k) {
  constexpr int kGrid = 32;
  constexpr double kMargin = 1.05;  // above the largest value on the grid: the density is smooth
  double largest = 0.0;
  for (int i = 0; i <= kGrid; ++i) {
    for (int j = 0; j <= kGrid; ++j) {
      const SurfacePoint point =
          strip_point(loft, k, static_cast<double>(i) / kGrid, static_cast<double>(j) / kGrid);
      largest = std::max(largest, point.density);
    }
  }
  return {[loft, k](double u, double v) { return strip_point(loft, k, u, v); }, kMargin * largest};
}

void add_corner_curve(Shape& shape, const Loft& loft, std::size_t k) {
  const std::size_t before = k + loft.first.size() - 1;
  for (int i = 0; i < kLoftChords; ++i) {
    const double u0 = static_cast<double>(i) / kLoftChords;
    const double u1 = static_cast<double>(i + 1) / kLoftChords;
    const double middle = 0.5 * (u0 + u1);
    const EdgeClass strength = crease_strength(strip_point(loft, before, middle, 1.0).normal,
                                               strip_point(loft, k, middle, 0.0).normal);
    if (strength == kNonEdge) continue;
    shape.edges.push_back({Segment{turned(corner(loft, k, u0), u0 * loft.angle),
                                   turned(corner(loft, k, u1), u1 * loft.angle)},
                           strength});
  }
}

/// The plane end of the part at u = 0 or 1.
void add_end(Shape& shape, const Loft& loft, double u) {
  // radial x z points against the turn, which is outwards at its start; at its end both the plane's
  // first axis and the outline are mirrored.
  const double side = u == 0.0 ? 1.0 : -1.0;
  const Vec3 radial = turned(Vec2(1.0, 0.0), u * loft.angle);
  std::vector<Vec2> outline;
  for (std::size_t k = 0; k < loft.first.size(); ++k) {
    const Vec2 p = corner(loft, k, u);
    outline.emplace_back(side * p.x(), p.y());
    shape.edges.push_back(
        {Segment{turned(p, u * loft.angle), turned(corner(loft, k + 1, u), u * loft.angle)}});
  }
  shape.patches.push_back(polygon(outline, Vec3::Zero(), side * radial, Vec3::UnitZ()));
}

}  // namespace

Shape make_shape(const Loft& loft) {
  Shape shape;
  for (std::size_t k = 0; k < loft.first.size(); ++k) {
    shape.patches.push_back(strip(loft, k));
    add_corner_curve(shape, loft, k);
  }
  add_end(shape, loft, 0.0);
  add_end(shape, loft, 1.0);
  return shape;
}

}  // namespace pcednet::shapes
