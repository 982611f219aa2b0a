#include "pcednet/lines/pieces/rim.h"

#include <Eigen/Geometry>
#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <limits>
#include <span>
#include <vector>

#include "pcednet/core/eigendecomposition.h"
#include "pcednet/core/rank.h"
#include "pcednet/core/vector_clones.h"
#include "pcednet/lines/pieces/ring.h"
#include "pcednet/lines/points/moments.h"

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

constexpr double kAlongAxis = 0.97;      ///< of normals of the plane and the axis, cosine
constexpr double kOneDirection = 0.999;  ///< of two axes, cosine
constexpr std::size_t kLeastWall = 5;    ///< points
constexpr std::size_t kMostPlaces = 16, kMostTriples = 40;
constexpr std::size_t kRimSectors = 8;
constexpr double kMostOpenWall = 2.3;  ///< radians without points; half a turn at the end of a slot
constexpr std::size_t kMostStray = 5;  ///< points of wall or plane to one of neither
constexpr double kLeastEdge = 0.5;  ///< share of the points near the rim that are of an edge class

/// Places from an edge point, and the normals there.
struct NearRows {
  using Row = std::array<double, kMostNear + kRankStep>;

  std::size_t count = 0;
  Row x{}, y{}, z{}, normal_x, normal_y, normal_z;
  Row height;  ///< along an axis

  void add(const Vec3& place, const Vec3& normal) {
    x[count] = place.x(), y[count] = place.y(), z[count] = place.z();
    normal_x[count] = normal.x(), normal_y[count] = normal.y(), normal_z[count] = normal.z();
    ++count;
  }
  Vec3 place(std::size_t i) const { return {x[i], y[i], z[i]}; }
  Vec3 normal(std::size_t i) const { return {normal_x[i], normal_y[i], normal_z[i]}; }
};

/// Marks with 1 the points with like normals that are in the plane of the first one, and returns
/// their number.
PCEDNET_VECTOR_CLONES
std::size_t mark_plane(const NearRows& near, std::size_t first, double reach, NearRows::Row& on) {
  const double a = near.normal_x[first], b = near.normal_y[first], c = near.normal_z[first];
  const double distance = a * near.x[first] + b * near.y[first] + c * near.z[first];
  std::size_t count = 0;
  for (std::size_t i = 0; i < near.count; ++i) {
    const double height = a * near.x[i] + b * near.y[i] + c * near.z[i] - distance;
    const double cosine = a * near.normal_x[i] + b * near.normal_y[i] + c * near.normal_z[i];
    const bool is_on = (std::fabs(height) < reach) & (std::fabs(cosine) > kAlongAxis);
    on[i] = is_on ? 1.0 : 0.0;
    count += static_cast<std::size_t>(is_on);
  }
  return count;
}

/// The normals of planes that several points are on.
std::vector<Vec3> likely_axes(const NearRows& near, double reach, std::size_t least) {
  std::vector<Vec3> axes;
  NearRows::Row on{};
  for (std::size_t i = 0; i < near.count; ++i) {
    const Vec3 normal = near.normal(i);
    const auto is_like = [&](const Vec3& other) {
      return std::abs(normal.dot(other)) > kAlongAxis;
    };
    if (std::any_of(axes.begin(), axes.end(), is_like)) continue;
    if (mark_plane(near, i, reach, on) < least) continue;
    const PointMoments moments =
        moments_of(near.x.data(), near.y.data(), near.z.data(), on.data(), near.count);
    const Vec3 axis = eigendecomposition(moments.covariance()).vectors.col(0).normalized();
    if (is_like(axis)) axes.push_back(axis);
  }
  return axes;
}

/// The heights at which many points are, each once, from heights in ascending order.
std::vector<double> levels_of(const std::vector<double>& heights, double reach, std::size_t least) {
  std::vector<double> levels;
  std::size_t begin = 0, end = 0;
  while (begin < heights.size()) {
    while (end < heights.size() && heights[end] < heights[begin] + 2.0 * reach) ++end;
    const std::size_t count = end - begin;
    if (count < least) {
      ++begin;
      continue;
    }
    double mean = 0.0;
    for (; begin < end; ++begin) mean += heights[begin] / static_cast<double>(count);
    levels.push_back(mean);
  }
  return levels;
}

PCEDNET_VECTOR_CLONES
void set_heights(NearRows& near, const Vec3& axis) {
  const double x = axis.x(), y = axis.y(), z = axis.z();
  for (std::size_t i = 0; i < near.count; ++i) {
    near.height[i] = x * near.x[i] + y * near.y[i] + z * near.z[i];
  }
}

/// The heights in ascending order.
std::vector<double> sorted_heights(NearRows& near) {
  constexpr double kInfinity = std::numeric_limits<double>::infinity();
  std::array<std::int64_t, kMostNear + kRankStep> ranks;
  std::fill_n(near.height.begin() + near.count, kRankStep, kInfinity);
  rank(near.height.data(), near.count, ranks.data());
  std::vector<double> sorted(near.count, -kInfinity);
  for (std::size_t i = 0; i < near.count; ++i) {
    sorted[static_cast<std::size_t>(ranks[i])] = near.height[i];
  }
  // Equal ones have one rank.
  for (std::size_t i = 1; i < near.count; ++i) sorted[i] = std::max(sorted[i], sorted[i - 1]);
  return sorted;
}

bool has_radius_of_a_bore(double radius, double spacing) {
  return radius > kLeastRadius * spacing && radius < kMostRadius * spacing;
}

/// The places of a wall, seen along its axis.
struct FlatPlaces {
  std::size_t count = 0;
  std::array<double, kMostPlaces> x, y;

  void add(double at_x, double at_y) {
    x[count] = at_x, y[count] = at_y;
    ++count;
  }
};

/// Circles through three places each, one per vector lane.
struct FlatCircles {
  using Row = std::array<double, kMostTriples>;

  std::size_t count = 0;
  Row x[3], y[3];  ///< of the places
  Row centre_x, centre_y, radius;
  std::array<std::int64_t, kMostTriples> on;  ///< places that are near the circle
};

/// At most kMostTriples of the triples, at even steps.
void choose_triples(const FlatPlaces& places, FlatCircles& circles) {
  const std::size_t n = places.count, step = 1 + n * (n - 1) * (n - 2) / 6 / kMostTriples;
  std::size_t skip = 0;
  for (std::size_t i = 0; i < n; ++i) {
    for (std::size_t j = i + 1; j < n; ++j) {
      std::size_t k = j + 1 + skip;
      for (; k < n; k += step) {
        const std::size_t triple[3] = {i, j, k};
        for (std::size_t m = 0; m < 3; ++m) {
          circles.x[m][circles.count] = places.x[triple[m]];
          circles.y[m][circles.count] = places.y[triple[m]];
        }
        ++circles.count;
      }
      skip = k - n;
    }
  }
}

/// Sets the circles, and how many of the places are nearer to each than `reach`; none to one that
/// cannot be of a bore.
PCEDNET_VECTOR_CLONES
void fit_circles(const FlatPlaces& places, double reach, double spacing, FlatCircles& circles) {
  const double least = kLeastRadius * spacing, most = kMostRadius * spacing;
  FlatCircles::Row sq_inner, sq_outer;
  for (std::size_t i = 0; i < circles.count; ++i) {
    const double at_x = circles.x[0][i], at_y = circles.y[0][i];
    const double ax = circles.x[1][i] - at_x, ay = circles.y[1][i] - at_y;
    const double bx = circles.x[2][i] - at_x, by = circles.y[2][i] - at_y;
    const double sq_a = ax * ax + ay * ay, sq_b = bx * bx + by * by;
    const double twice_area = ax * by - ay * bx, per_area = 0.5 / twice_area;
    const double x = (by * sq_a - ay * sq_b) * per_area, y = (ax * sq_b - bx * sq_a) * per_area;
    const double radius = std::sqrt(x * x + y * y);
    const bool can_be =
        (radius > least) & (radius < most) & (twice_area * twice_area >= 1e-18 * sq_a * sq_b);
    circles.centre_x[i] = at_x + x, circles.centre_y[i] = at_y + y;
    circles.radius[i] = radius;
    sq_inner[i] = (radius - reach) * (radius - reach);
    sq_outer[i] = can_be ? (radius + reach) * (radius + reach) : 0.0;
    circles.on[i] = 0;
  }
  for (std::size_t k = 0; k < places.count; ++k) {
    const double place_x = places.x[k], place_y = places.y[k];
    for (std::size_t i = 0; i < circles.count; ++i) {
      const double x = place_x - circles.centre_x[i], y = place_y - circles.centre_y[i];
      const double sq_away = x * x + y * y;
      circles.on[i] +=
          static_cast<int>(sq_away > sq_inner[i]) & static_cast<int>(sq_away < sq_outer[i]);
    }
  }
}

struct FlatCircle {
  Eigen::Vector2d centre;
  double radius;
};

/// The circle through three of the places that the most of them are on.
std::optional<FlatCircle> common_circle(const FlatPlaces& places, const RimTest& test,
                                        double spacing) {
  FlatCircles circles;
  choose_triples(places, circles);
  fit_circles(places, test.reach * spacing, spacing, circles);
  const auto end = circles.on.begin() + static_cast<std::ptrdiff_t>(circles.count);
  const auto best = std::max_element(circles.on.begin(), end);
  const auto most = static_cast<std::size_t>(*best);
  const double least = test.share * static_cast<double>(places.count);
  if (most < kLeastWall || static_cast<double>(most) < least) return std::nullopt;
  const auto i = static_cast<std::size_t>(best - circles.on.begin());
  return FlatCircle{{circles.centre_x[i], circles.centre_y[i]}, circles.radius[i]};
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

bool is_all_along(const Sectors& sectors, const RimTest& test) {
  return sectors.covered() + test.missing >= kRimSectors;
}

/// Whether the plane is around the circle (true) or within it (false); nothing if on both sides or
/// not all along.
std::optional<bool> plane_is_outside(const Fit& circle, const OrderedPoints& cloud,
                                     std::span<const Beside> points, const RimTest& test) {
  const double reach = test.reach;
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
  if (!is_all_along(plane, test)) return std::nullopt;
  if (kMostStray * (is_outside ? far_in : far_out) > plane.points()) return std::nullopt;
  return is_outside;
}

/// Whether there is a wall all along the circle, on one side of the plane alone.
bool has_wall(const Fit& circle, const OrderedPoints& cloud, std::span<const Beside> points,
              const RimTest& test) {
  Sectors wall(circle, kRimSectors);
  std::vector<double> angles;
  std::size_t beyond = 0, off = 0;
  for (const Beside& point : points) {
    const bool on = std::abs(point.out) < test.reach;
    if (on && has_height_of_wall(point.height)) {
      angles.push_back(wall.add(cloud.position(point.index)));
    }
    beyond += on && has_height_of_wall(-point.height);
    off += !on && has_height_of_wall(point.height) && std::abs(point.out) < kOffWall;
  }
  return is_all_along(wall, test) && widest_gap(angles) < kMostOpenWall &&
         kMostStray * beyond <= wall.points() &&
         static_cast<double>(off) <= test.off * static_cast<double>(wall.points());
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
std::optional<Rim> rim_of(Fit circle, const OrderedPoints& cloud, const RimTest& test,
                          double spacing) {
  std::vector<spatial::Neighbour> near;
  cloud.within(circle.point, circle.radius + (1.0 + kPlaneEnds) * spacing, near);
  std::vector<Beside> points = points_beside(circle, cloud, near, spacing);
  for (const double within : {2.0 * test.reach, test.reach}) {
    if (!fit_to_wall(circle, cloud, points, within, spacing)) return std::nullopt;
    points = points_beside(circle, cloud, near, spacing);
  }
  if (!is_of_edges(cloud, points) || !has_wall(circle, cloud, points, test)) return std::nullopt;
  const auto is_bore = plane_is_outside(circle, cloud, points, test);
  if (!is_bore) return std::nullopt;
  return Rim{circle, *is_bore};
}

/// The first circle of the rim of a wall that rises from the plane at `level` along the axis
/// (`side` 1) or against it (-1).
std::optional<Fit> circle_of_wall(const NearRows& near, const Vec3& axis, double level, double side,
                                  const RimTest& test, double spacing) {
  const Vec3 x = axis.unitOrthogonal(), y = axis.cross(x);
  FlatPlaces places;
  for (std::size_t i = 0; i < near.count && places.count < kMostPlaces; ++i) {  // nearest first
    if (!has_height_of_wall(side * (near.height[i] - level) / spacing)) continue;
    places.add(near.place(i).dot(x), near.place(i).dot(y));
  }
  if (places.count < kLeastWall) return std::nullopt;
  const auto circle = common_circle(places, test, spacing);
  if (!circle) return std::nullopt;
  const double away = std::abs(circle->centre.norm() - circle->radius);
  if (away > kFromWall * spacing) return std::nullopt;
  const Vec3 centre = level * axis + circle->centre.x() * x + circle->centre.y() * y;
  return Fit{CurveKind::kArc, centre, side * axis, circle->radius, 0.0};
}

}  // namespace

std::optional<Rim> rim_near(const OrderedPoints& cloud, std::uint32_t edge_point,
                            std::span<const Vec3> common_axes, const RimTest& test,
                            double spacing) {
  const Vec3& at = cloud.position(edge_point);
  std::vector<spatial::Neighbour> near;
  cloud.within(at, kLook * spacing, near);
  if (near.size() > kMostNear) return std::nullopt;
  std::stable_sort(near.begin(), near.end(),
                   [](const auto& a, const auto& b) { return a.sq_distance < b.sq_distance; });
  NearRows rows;
  for (const auto& point : near) {
    rows.add(cloud.position(point.index) - at, cloud.normal(point.index));
  }
  std::vector<Vec3> axes = likely_axes(rows, test.reach * spacing, test.plane);
  for (const Vec3& common : common_axes) {
    const bool is_known = std::any_of(axes.begin(), axes.end(), [&](const Vec3& other) {
      return std::abs(common.dot(other)) > kOneDirection;
    });
    if (!is_known) axes.push_back(common);
  }
  for (const Vec3& axis : axes) {
    set_heights(rows, axis);
    for (const double level : levels_of(sorted_heights(rows), test.reach * spacing, test.plane)) {
      if (std::abs(level) >= kFromPlane * spacing) continue;
      for (const double side : {1.0, -1.0}) {
        auto circle = circle_of_wall(rows, axis, level, side, test, spacing);
        if (!circle) continue;
        circle->point += at;
        if (auto rim = rim_of(*circle, cloud, test, spacing)) return rim;
      }
    }
  }
  return std::nullopt;
}

}  // namespace pcednet::lines
