#include "pcednet/lines/pieces/refine_circle.h"

#include <Eigen/Cholesky>
#include <Eigen/Eigenvalues>
#include <Eigen/Geometry>
#include <array>
#include <cmath>
#include <span>
#include <utility>

#include "pcednet/core/half_space.h"
#include "pcednet/lines/pieces/blunt.h"
#include "pcednet/lines/pieces/mean_sides.h"
#include "pcednet/lines/points/moments.h"

namespace pcednet::lines {
namespace {

constexpr int kAxisFits = 3;
/// Axis, centre and rays stay where they are unless this many points, at a distance of one spacing,
/// say otherwise.
constexpr double kTrust = 4.0;
constexpr double kLeastSineOfSurfaces = 0.3;  ///< of the angle between the surfaces

/// A point beside a circle: where it is in the half-plane of the axis, from the circle, and the
/// direction outwards there.
struct RimPoint {
  Eigen::Vector2d at;       ///< (outward, along the axis), spacings
  Eigen::Vector2d outward;  ///< unit, in the frame of the circle
};

/// The directions of a circle's plane.
struct CircleFrame {
  Vec3 u, v;
};

/// A side of an arc in its half-plane.
struct Ray {
  Eigen::Vector2d side;  ///< unit: roughly its direction
  Eigen::Vector2d point, direction;
  Support support = {};

  Eigen::Vector2d normal() const { return {-direction.y(), direction.x()}; }
  double off(const Eigen::Vector2d& at) const { return std::abs((at - point).dot(normal())); }
};

/// Whether the place is beside the arc, not beyond its ends.
bool is_beside(const Piece& piece, const Vec3& place) {
  if (piece.closed) return true;
  const auto angle = [&](const Vec3& to) {
    return turn_about(piece.fit.direction, piece.ends[0] - piece.fit.point, to - piece.fit.point);
  };
  return angle(place) <= angle(piece.ends[1]);
}

std::vector<RimPoint> rim_points(const Fit& circle, const CircleFrame& frame,
                                 std::span<const Vec3> points, double spacing) {
  std::vector<RimPoint> all;
  for (const Vec3& point : points) {
    const Vec3 offset = point - circle.point;
    const Eigen::Vector2d across(offset.dot(frame.u), offset.dot(frame.v));
    const double away = across.norm();
    if (!(away > 0.0)) continue;
    all.push_back({{(away - circle.radius) / spacing, offset.dot(circle.direction) / spacing},
                   across / away});
  }
  return all;
}

/// The points of a side that are on its ray, and not rather on that of the other side.
std::vector<RimPoint> on_ray(const Ray& ray, const Ray& other, std::span<const RimPoint> points,
                             const SideLimits& limits, double widened = 1.0) {
  std::vector<RimPoint> on;
  for (const RimPoint& point : points) {
    const double away = point.at.dot(ray.side), off = ray.off(point.at);
    if (away < kFromEdge || away > kSideOfSurface || off > widened * limits.tolerance) continue;
    if (point.at.dot(other.side) > 0.0 && other.off(point.at) < off) continue;
    on.push_back(point);
  }
  return on;
}

/// The ray through these points; none if they are few or in one place.
std::optional<Ray> ray_through(std::span<const RimPoint> points, const Eigen::Vector2d& side) {
  FlatMoments on;
  for (const RimPoint& point : points) on.add(point.at);
  if (on.count < kLeastOfSide) return std::nullopt;
  Eigen::SelfAdjointEigenSolver<Eigen::Matrix2d> solver;
  solver.computeDirect(on.covariance());
  if (!(solver.eigenvalues()[1] > 0.2)) return std::nullopt;
  const Eigen::Vector2d direction = solver.eigenvectors().col(1);
  return Ray{side,
             on.mean(),
             direction.dot(side) < 0.0 ? Eigen::Vector2d(-direction) : direction,
             {on.count, on.count * solver.eigenvalues()[0]}};
}

using Rays = std::array<Ray, 2>;

/// The rays of both sides.
std::optional<Rays> rays_of(const Sides& sides, std::span<const RimPoint> points,
                            const SideLimits& limits) {
  const Eigen::Vector2d edge = Eigen::Vector2d::Zero();
  Rays rays = {Ray{sides[0], edge, sides[0]}, Ray{sides[1], edge, sides[1]}};
  for (int fit = 0; fit < kSideFits; ++fit) {
    const double widened = fit == 0 ? 1.5 : 1.0;
    const auto a = ray_through(on_ray(rays[0], rays[1], points, limits, widened), sides[0]);
    const auto b = ray_through(on_ray(rays[1], rays[0], points, limits, widened), sides[1]);
    if (!a || !b) return std::nullopt;
    rays = {*a, *b};
  }
  return rays;
}

/// The mean of each side over the nodes in the half-plane.
std::optional<Sides> sides_about_axis(const Piece& piece) {
  std::vector<Sides> sides;
  for (const ChainNode& node : piece.nodes) {
    const Vec3 tangent = tangent_at(piece.fit, node.at);
    const Vec3 outward = tangent.cross(piece.fit.direction);
    const auto turned = [&](const Vec3& side) {
      return Eigen::Vector2d(side.dot(outward), side.dot(piece.fit.direction));
    };
    sides.push_back({turned(node.side_a), turned(node.side_b)});
  }
  return mean_sides(sides, 0.8);
}

/// The points beside a circle, seen about its axis, and the surfaces there.
struct Section {
  CircleFrame frame;
  std::vector<RimPoint> points;
  Rays rays;
  double sine;  ///< of the angle between them, signed
};

std::optional<Section> section_about(const Fit& circle, const Sides& sides,
                                     std::span<const Vec3> points, const SideLimits& limits,
                                     double spacing) {
  const Vec3 u = circle.direction.unitOrthogonal();
  const CircleFrame frame{u, circle.direction.cross(u)};
  std::vector<RimPoint> seen = rim_points(circle, frame, points, spacing);
  const auto rays = rays_of(sides, seen, limits);
  if (!rays) return std::nullopt;
  const Eigen::Vector2d &a = (*rays)[0].direction, &b = (*rays)[1].direction;
  const double sine = a.x() * b.y() - a.y() * b.x();
  if (std::abs(sine) < kLeastSineOfSurfaces) return std::nullopt;
  return Section{frame, std::move(seen), *rays, sine};
}

/// The circle with its axis turned and its centre moved in its plane, so that the points are nearer
/// to their rays, whose places and directions are free, too.
Fit straightened(const Fit& circle, const Section& section, const SideLimits& limits,
                 double spacing) {
  using Vector8 = Eigen::Matrix<double, 8, 1>;
  Eigen::Matrix<double, 8, 8> products = Eigen::Matrix<double, 8, 8>::Zero();
  Vector8 sums = Vector8::Zero();
  const double radius = circle.radius / spacing;
  for (const int side : {0, 1}) {
    const Ray& ray = section.rays[side];
    const Eigen::Vector2d normal = ray.normal();
    for (const RimPoint& point : on_ray(ray, section.rays[1 - side], section.points, limits)) {
      const Eigen::Vector2d from_ray = point.at - ray.point;
      // How the distance changes with the centre, with the rim as the axis turns, and with the ray.
      const double turned =
          normal.y() * (radius + point.at.x()) / radius - normal.x() * point.at.y() / radius;
      Vector8 change = Vector8::Zero();
      change.segment<2>(0) = -normal.x() * point.outward;
      change.segment<2>(2) = turned * point.outward;
      change[4 + 2 * side] = -1.0;
      change[5 + 2 * side] = -from_ray.dot(ray.direction);
      products += change * change.transpose();
      sums -= from_ray.dot(normal) * change;
    }
  }
  products.diagonal().array() += kTrust;
  const Vector8 step = products.ldlt().solve(sums);
  Fit better = circle;
  better.point += spacing * (step[0] * section.frame.u + step[1] * section.frame.v);
  better.direction =
      (circle.direction + (step[2] * section.frame.u + step[3] * section.frame.v) / radius)
          .normalized();
  return better;
}

/// Where the surfaces meet, or their blunt edge is.
Eigen::Vector2d edge_of(const Section& section) {
  const auto& [a, b] = section.rays;
  const Eigen::Vector2d between = b.point - a.point;
  const double along =
      (between.x() * b.direction.y() - between.y() * b.direction.x()) / section.sine;
  const Eigen::Vector2d corner = a.point + along * a.direction;
  std::vector<Eigen::Vector2d> places;
  for (const RimPoint& point : section.points) places.push_back(point.at - corner);
  return corner + blunted(places, a.direction, b.direction);
}

}  // namespace

std::optional<Placed> crease_circle(const Piece& piece, const std::vector<Vec3>& points,
                                    const SideLimits& limits) {
  const auto sides = sides_about_axis(piece);
  if (!sides) return std::nullopt;
  std::vector<Vec3> near;
  for (const Vec3& point : points) {
    if (is_beside(piece, point)) near.push_back(point);
  }
  const double spacing = piece.spacing();
  Fit fit = piece.fit;
  auto section = section_about(fit, *sides, near, limits, spacing);
  for (int round = 0; section && round < kAxisFits; ++round) {
    fit = straightened(fit, *section, limits, spacing);
    section = section_about(fit, *sides, near, limits, spacing);
  }
  if (!section) return std::nullopt;
  const Eigen::Vector2d edge = spacing * edge_of(*section);
  fit.radius += edge.x();
  fit.point += edge.y() * fit.direction;
  if (!(fit.radius > 0.0)) return std::nullopt;
  const auto& [a, b] = section->rays;
  const auto in_space = [](const Eigen::Vector2d& v) { return Vec3(v.x(), v.y(), 0.0); };
  return Placed{fit, dihedral_angle(in_space(a.direction), in_space(b.direction)),
                a.support + b.support};
}

}  // namespace pcednet::lines
