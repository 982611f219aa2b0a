#include "pcednet/lines/rim.h"

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <span>
#include <vector>

#include "pcednet/core/eigendecomposition.h"
#include "pcednet/lines/moments.h"
#include "pcednet/lines/ring.h"

namespace pcednet::lines {
namespace {

// In spacings.
constexpr double kLeastRadius = 1.5, kMostRadius = 6.0;
constexpr double kLook = 4.0;           ///< from the edge point
constexpr std::size_t kMostNear = 200;  ///< points there; with more, the spacing is not theirs
constexpr double kFromPlane = 1.0, kFromWall = 1.0;   ///< of the edge point
constexpr double kWallBegins = 0.3, kWallEnds = 2.5;  ///< from the plane
constexpr double kPlaneEnds = 2.0;                    ///< from the wall
constexpr double kOffWall = 1.0;                      ///< from it, where few points may be

constexpr double kAlongAxis = 0.97;  ///< of normals of the plane and the axis, cosine
constexpr std::size_t kLeastPlane = 6, kLeastWall = 5;  ///< points
constexpr std::size_t kMostPlaces = 16, kMostTriples = 40;
constexpr std::size_t kRimSectors = 8;
constexpr std::size_t kMostStray = 5;  ///< one such to so many of wall or plane
constexpr double kLeastEdge = 0.5;  ///< share of the points near the rim that are of an edge class

/// A plane across the axis of a bore, perhaps.
struct Cap {
  Vec3 point, normal;
};

/// The normal of the plane of least squares.
Vec3 normal_of(const OrderedPoints& cloud, const std::vector<std::uint32_t>& points) {
  PointMoments moments;
  for (const std::uint32_t i : points) {
    moments.add(cloud.position(i) - cloud.position(points.front()));
  }
  return eigendecomposition(moments.covariance()).vectors.col(0).normalized();
}

/// The normals of planes that several points are on.
std::vector<Vec3> likely_axes(const OrderedPoints& cloud, std::span<const spatial::Neighbour> near,
                              double reach) {
  std::vector<Vec3> axes;
  std::vector<std::uint32_t> on;
  for (const auto& first : near) {
    const Vec3 &at = cloud.position(first.index), normal = cloud.normal(first.index);
    const auto is_like = [&](const Vec3& other) {
      return std::abs(normal.dot(other)) > kAlongAxis;
    };
    if (std::any_of(axes.begin(), axes.end(), is_like)) continue;
    on.clear();
    for (const auto& other : near) {
      if (!is_like(cloud.normal(other.index))) continue;
      const double height = normal.dot(cloud.position(other.index) - at);
      if (std::abs(height) < reach) on.push_back(other.index);
    }
    if (on.size() < kLeastPlane) continue;
    const Vec3 axis = normal_of(cloud, on);
    if (is_like(axis)) axes.push_back(axis);
  }
  return axes;
}

/// The heights at which many points are, each once, from heights in ascending order.
std::vector<double> levels_of(const std::vector<double>& heights, double reach) {
  std::vector<double> levels;
  std::size_t begin = 0, end = 0;
  while (begin < heights.size()) {
    while (end < heights.size() && heights[end] < heights[begin] + 2.0 * reach) ++end;
    const std::size_t count = end - begin;
    if (count < kLeastPlane) {
      ++begin;
      continue;
    }
    double mean = 0.0;
    for (; begin < end; ++begin) mean += heights[begin] / static_cast<double>(count);
    levels.push_back(mean);
  }
  return levels;
}

/// The planes with many points that may be across the axis of a bore at `at`.
std::vector<Cap> likely_caps(const OrderedPoints& cloud, std::span<const spatial::Neighbour> near,
                             const Vec3& at, double reach, double spacing) {
  std::vector<Cap> caps;
  std::vector<double> heights;
  for (const Vec3& axis : likely_axes(cloud, near, reach * spacing)) {
    heights.clear();
    for (const auto& point : near) heights.push_back(axis.dot(cloud.position(point.index) - at));
    std::sort(heights.begin(), heights.end());
    for (const double level : levels_of(heights, reach * spacing)) {
      if (std::abs(level) < kFromPlane * spacing) caps.push_back({at + level * axis, axis});
    }
  }
  return caps;
}

struct FlatCircle {
  Eigen::Vector2d centre;
  double radius;
};

std::optional<FlatCircle> circle_through(const Eigen::Vector2d& at, const Eigen::Vector2d& second,
                                         const Eigen::Vector2d& third) {
  const Eigen::Vector2d a = second - at, b = third - at;
  const double twice_area = a.x() * b.y() - a.y() * b.x();
  if (std::abs(twice_area) < 1e-9 * a.norm() * b.norm()) return std::nullopt;
  const Eigen::Vector2d across(b.y() * a.squaredNorm() - a.y() * b.squaredNorm(),
                               a.x() * b.squaredNorm() - b.x() * a.squaredNorm());
  const Eigen::Vector2d offset = across / (2.0 * twice_area);
  return FlatCircle{at + offset, offset.norm()};
}

bool has_radius_of_a_bore(double radius, double spacing) {
  return radius > kLeastRadius * spacing && radius < kMostRadius * spacing;
}

/// Of the circles through three of the places, that which the most of them are on.
std::optional<FlatCircle> common_circle(const std::vector<Eigen::Vector2d>& places, double reach,
                                        double spacing) {
  const std::size_t n = places.size(), step = 1 + n * (n - 1) * (n - 2) / 6 / kMostTriples;
  FlatCircle best{Eigen::Vector2d::Zero(), 0.0};
  std::size_t most = 0, number = 0;
  for (std::size_t i = 0; i < n; ++i) {
    for (std::size_t j = i + 1; j < n; ++j) {
      for (std::size_t k = j + 1; k < n; ++k) {
        if (number++ % step != 0) continue;
        const auto circle = circle_through(places[i], places[j], places[k]);
        if (!circle || !has_radius_of_a_bore(circle->radius, spacing)) continue;
        std::size_t on = 0;
        for (const Eigen::Vector2d& place : places) {
          on += std::abs((place - circle->centre).norm() - circle->radius) < reach * spacing;
        }
        if (on > most) best = *circle, most = on;
      }
    }
  }
  if (most < kLeastWall || 3 * most < 2 * n) return std::nullopt;
  return best;
}

/// Where a point is in the half-plane of a circle's axis, in spacings.
struct Beside {
  std::uint32_t index;
  double out, height;  ///< outward from the circle, along the axis
};

std::vector<Beside> points_beside(const Fit& circle, const OrderedPoints& cloud,
                                  std::span<const spatial::Neighbour> near, double spacing) {
  std::vector<Beside> points;
  for (const auto& point : near) {
    const Eigen::Vector2d place = about_axis(circle, cloud.position(point.index));
    points.push_back({point.index, (place.x() - circle.radius) / spacing, place.y() / spacing});
  }
  return points;
}

bool has_height_of_wall(double height) {
  return height > kWallBegins && height < kWallEnds;
}

/// Moves the circle to the points of the wall, by least squares.
bool fit_to_wall(Fit& circle, const OrderedPoints& cloud, std::span<const Beside> points,
                 double reach, double spacing) {
  std::vector<Vec3> wall;  // in the plane of the circle
  for (const Beside& point : points) {
    if (!has_height_of_wall(point.height) || std::abs(point.out) > reach) continue;
    wall.push_back(cloud.position(point.index) - point.height * spacing * circle.direction);
  }
  if (wall.size() < kLeastWall) return false;
  const Fit fit = fit_arc(wall, spacing);
  if (fit.kind != CurveKind::kArc) return false;
  circle.point = fit.point;
  circle.radius = fit.radius;
  return has_radius_of_a_bore(fit.radius, spacing);
}

bool is_all_along(const Sectors& sectors) {
  return sectors.covered() + 1 >= kRimSectors;
}

/// Whether the plane is around the circle (true) or within it (false); nothing if on both sides or
/// not all along.
std::optional<bool> plane_is_outside(const Fit& circle, const OrderedPoints& cloud,
                                     std::span<const Beside> points, double reach) {
  Sectors outside(circle, kRimSectors), inside(circle, kRimSectors);
  std::size_t far_out = 0, far_in = 0;
  for (const Beside& point : points) {
    if (std::abs(point.height) > reach || std::abs(point.out) > kPlaneEnds) continue;
    const Vec3& place = cloud.position(point.index);
    if (point.out > -reach) outside.add(place);
    if (point.out < reach) inside.add(place);
    far_out += point.out > 2.0 * reach;
    far_in += point.out < -2.0 * reach;
  }
  const bool is_outside = outside.points() > inside.points();
  const Sectors& plane = is_outside ? outside : inside;
  if (!is_all_along(plane)) return std::nullopt;
  if (kMostStray * (is_outside ? far_in : far_out) > plane.points()) return std::nullopt;
  return is_outside;
}

/// Whether there is a wall all along the circle, on one side of the plane alone.
bool has_wall(const Fit& circle, const OrderedPoints& cloud, std::span<const Beside> points,
              double reach) {
  Sectors wall(circle, kRimSectors);
  std::size_t beyond = 0, off = 0;
  for (const Beside& point : points) {
    const bool on = std::abs(point.out) < reach;
    if (on && has_height_of_wall(point.height)) wall.add(cloud.position(point.index));
    beyond += on && has_height_of_wall(-point.height);
    off += !on && has_height_of_wall(point.height) && std::abs(point.out) < kOffWall;
  }
  return is_all_along(wall) && kMostStray * beyond <= wall.points() && 3 * off <= wall.points();
}

bool is_of_edges(const OrderedPoints& cloud, std::span<const Beside> points) {
  double close = 0.0, edges = 0.0;
  for (const Beside& point : points) {
    if (point.out * point.out + point.height * point.height > 1.0) continue;
    close += 1.0;
    edges += cloud.is_edge(point.index) ? 1.0 : 0.0;
  }
  return edges >= kLeastEdge * close;
}

/// The rim that a first circle is near, if the points speak for one.
std::optional<Rim> rim_of(Fit circle, const OrderedPoints& cloud, double reach, double spacing) {
  std::vector<spatial::Neighbour> near;
  cloud.tree().within_unsorted(circle.point, circle.radius + (1.0 + kPlaneEnds) * spacing, near);
  std::vector<Beside> points = points_beside(circle, cloud, near, spacing);
  for (const double within : {2.0 * reach, reach}) {
    if (!fit_to_wall(circle, cloud, points, within, spacing)) return std::nullopt;
    points = points_beside(circle, cloud, near, spacing);
  }
  if (!is_of_edges(cloud, points) || !has_wall(circle, cloud, points, reach)) return std::nullopt;
  const auto is_bore = plane_is_outside(circle, cloud, points, reach);
  if (!is_bore) return std::nullopt;
  return Rim{circle, *is_bore};
}

}  // namespace

std::optional<Rim> rim_near(const OrderedPoints& cloud, std::uint32_t edge_point, double reach,
                            double spacing) {
  const Vec3& at = cloud.position(edge_point);
  std::vector<spatial::Neighbour> near;
  cloud.tree().within(at, kLook * spacing, near);
  if (near.size() > kMostNear) return std::nullopt;
  std::vector<Eigen::Vector2d> places;
  for (const Cap& cap : likely_caps(cloud, near, at, reach, spacing)) {
    const Vec3 x = cap.normal.unitOrthogonal(), y = cap.normal.cross(x);
    for (const double side : {1.0, -1.0}) {
      places.clear();
      for (const auto& point : near) {  // the nearest first
        const Vec3 offset = cloud.position(point.index) - cap.point;
        if (!has_height_of_wall(side * offset.dot(cap.normal) / spacing)) continue;
        places.emplace_back(offset.dot(x), offset.dot(y));
        if (places.size() == kMostPlaces) break;
      }
      if (places.size() < kLeastWall) continue;
      const auto flat = common_circle(places, reach, spacing);
      if (!flat) continue;
      const Eigen::Vector2d own((at - cap.point).dot(x), (at - cap.point).dot(y));
      const double away = std::abs((own - flat->centre).norm() - flat->radius);
      if (away > kFromWall * spacing) continue;
      const Fit circle{CurveKind::kArc, cap.point + flat->centre.x() * x + flat->centre.y() * y,
                       side * cap.normal, flat->radius, 0.0};
      if (auto rim = rim_of(circle, cloud, reach, spacing)) return rim;
    }
  }
  return std::nullopt;
}

}  // namespace pcednet::lines
