#include "workbench/shapes/surfaces/patches.h"

#include <algorithm>
#include <cmath>
#include <numbers>
#include <utility>

namespace pcednet::shapes {
namespace {

bool inside(const std::vector<Vec2>& outline, const Vec2& point) {
  bool odd = false;
  for (std::size_t i = 0; i < outline.size(); ++i) {
    const Vec2& a = outline[i];
    const Vec2& b = outline[(i + 1) % outline.size()];
    if ((a.y() > point.y()) == (b.y() > point.y())) continue;
    if (point.x() < a.x() + (b.x() - a.x()) * (point.y() - a.y()) / (b.y() - a.y())) odd = !odd;
  }
  return odd;
}

}  // namespace

SurfacePatch parallelogram(const Vec3& origin, const Vec3& along, const Vec3& across) {
  const Vec3 cross = along.cross(across);
  const double area = cross.norm();
  const Vec3 normal = cross / area;
  return {[=](double u, double v) {
            return SurfacePoint{origin + u * along + v * across, normal, area};
          },
          area};
}

SurfacePatch triangle(const Vec3& a, const Vec3& b, const Vec3& c) {
  const Vec3 cross = (b - a).cross(c - a);
  const double half = 0.5 * cross.norm();
  const Vec3 normal = cross.normalized();
  // The unit square is folded over its diagonal, so each half covers the triangle once.
  return {[=](double u, double v) {
            if (u + v > 1.0) {
              u = 1.0 - u;
              v = 1.0 - v;
            }
            return SurfacePoint{a + u * (b - a) + v * (c - a), normal, half};
          },
          half};
}

SurfacePatch polygon(std::vector<Vec2> outline, const Vec3& origin, const Vec3& a, const Vec3& b) {
  Vec2 low = outline.front();
  Vec2 high = outline.front();
  for (const Vec2& corner : outline) {
    low = low.cwiseMin(corner);
    high = high.cwiseMax(corner);
  }
  const Vec2 size = high - low;
  const double area = size.x() * size.y();
  const Vec3 normal = a.cross(b);
  return {[=, outline = std::move(outline)](double u, double v) {
            const Vec2 p = low + Vec2(u * size.x(), v * size.y());
            return SurfacePoint{origin + p.x() * a + p.y() * b, normal,
                                inside(outline, p) ? area : 0.0};
          },
          area};
}

SurfacePatch revolved_line(const Vec2& from, const Vec2& to, double angle) {
  const Vec2 step = to - from;
  const double length = step.norm();
  return {[=](double u, double v) {
            const Vec2 p = from + v * step;
            const double c = std::cos(u * angle);
            const double s = std::sin(u * angle);
            const Vec3 normal(step.y() / length * c, step.y() / length * s, -step.x() / length);
            return SurfacePoint{Vec3(p.x() * c, p.x() * s, p.y()), normal, p.x() * length * angle};
          },
          std::max(from.x(), to.x()) * length * angle};
}

SurfacePatch revolved_arc(const Vec2& centre, double size, double start, double end, double angle) {
  const double side = start < end ? 1.0 : -1.0;
  const double length = size * std::abs(end - start);
  return {[=](double u, double v) {
            const double t = start + v * (end - start);
            const Vec2 out(std::cos(t), std::sin(t));
            const Vec2 p = centre + size * out;
            const double c = std::cos(u * angle);
            const double s = std::sin(u * angle);
            const Vec3 normal(out.x() * c, out.x() * s, out.y());
            return SurfacePoint{Vec3(p.x() * c, p.x() * s, p.y()), side * normal,
                                std::max(0.0, p.x()) * length * angle};
          },
          (centre.x() + size) * length * angle};
}

SurfacePatch cylinder_strip(const Vec3& a, const Vec3& b, const Vec3& x, double size,
                            double angle) {
  const Vec3 y = (b - a).normalized().cross(x);
  const double area = size * angle * (b - a).norm();
  return {[=](double u, double v) {
            const Vec3 out = std::cos(u * angle) * x + std::sin(u * angle) * y;
            return SurfacePoint{a + v * (b - a) + size * out, out, area};
          },
          area};
}

SurfacePatch graph(const HeightField& field, const Vec2& low, const Vec2& high) {
  const Vec2 size = high - low;
  const double area = size.x() * size.y();
  return {[=](double u, double v) {
            const Vec2 p = low + Vec2(u * size.x(), v * size.y());
            const Vec2 g = field.gradient(p.x(), p.y());
            const double slant = std::sqrt(1.0 + g.squaredNorm());
            return SurfacePoint{Vec3(p.x(), p.y(), field.height(p.x(), p.y())),
                                Vec3(-g.x(), -g.y(), 1.0) / slant, area * slant};
          },
          area * std::sqrt(1.0 + field.max_slope * field.max_slope)};
}

EdgeCurve circle(double radius, double height, EdgeClass strength) {
  return {Arc{Vec3(0, 0, height), Vec3::UnitX(), Vec3::UnitY(), radius, 2.0 * std::numbers::pi},
          strength};
}

}  // namespace pcednet::shapes
