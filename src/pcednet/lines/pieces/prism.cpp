#include "pcednet/lines/pieces/prism.h"

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <limits>

#include "pcednet/lines/points/chart.h"

namespace pcednet::lines {
namespace {

constexpr std::size_t kLeastSides = 3, kMostSides = 12;
constexpr double kAlongPrism = 0.98;               ///< of a segment and the axis, cosine
constexpr double kWidestTurn = 0.45 * kWholeTurn;  ///< from a corner to the next
constexpr double kEvenTurn = kWholeTurn / 24.0;    ///< difference of two turns that are one
constexpr double kFarthestCorner = 0.45;           ///< beyond the circle, in radii: of a triangle

// In spacings.
constexpr double kEndFromPlane = 5.0;      ///< of a segment along the axis
constexpr double kCornerFromCircle = 0.5;  ///< more than the above
constexpr double kOneCorner = 1.0;         ///< corners less apart are one
constexpr double kSidesBegin = 0.3, kSidesEnd = 2.5, kBesideCircle = 1.0;

using Flat = Chart::Flat;

/// A corner seen along the axis.
struct FlatCorner {
  double angle, radius;

  Flat place() const { return {radius * std::cos(angle), radius * std::sin(angle)}; }
};

/// Where segments that come down along the axis meet the plane, their wedges open to it.
std::vector<FlatCorner> corners_seen(const Rim& rim, const Chart& chart,
                                     const std::vector<Piece>& pieces, const EndIndex& ends,
                                     double spacing) {
  const double radius = rim.circle.radius;
  const double most = (1.0 + kFarthestCorner) * radius + kCornerFromCircle * spacing;
  std::vector<spatial::Neighbour> near;
  ends.tree.within(chart.origin, most + kEndFromPlane * spacing, near);
  std::vector<FlatCorner> corners;
  for (const auto& found : near) {
    const auto [i, side] = ends.ends[found.index];
    const Vec3 down = outward(pieces[i], side);
    const double cosine = down.dot(rim.circle.direction),
                 height = about_axis(rim.circle, ends.places[found.index]).y();
    if (cosine > -kAlongPrism || std::abs(height) > kEndFromPlane * spacing) continue;
    const Vec3 meets = ends.places[found.index] - height / cosine * down;
    const Flat flat = chart.flat(meets);
    if (flat.norm() < radius - kCornerFromCircle * spacing || flat.norm() > most) continue;
    const Vec3 out = meets - chart.origin;
    const ChainNode& node = pieces[i].middle();
    if (node.side_a.dot(out) > 0.0 || node.side_b.dot(out) > 0.0) continue;
    const bool is_known = std::any_of(corners.begin(), corners.end(), [&](const FlatCorner& other) {
      return (other.place() - flat).norm() < kOneCorner * spacing;
    });
    if (!is_known) corners.push_back({std::atan2(flat.y(), flat.x()), flat.norm()});
  }
  return corners;
}

/// The corners in their order, with those that are missing between others at even angles. Empty if
/// a side would be too long.
std::vector<FlatCorner> all_around(std::vector<FlatCorner> corners) {
  std::sort(corners.begin(), corners.end(),
            [](const FlatCorner& a, const FlatCorner& b) { return a.angle < b.angle; });
  corners.push_back(corners.front());
  corners.back().angle += kWholeTurn;
  std::vector<double> turns;
  for (std::size_t i = 0; i + 1 < corners.size(); ++i) {
    turns.push_back(corners[i + 1].angle - corners[i].angle);
  }
  std::vector<double> sorted = turns;
  std::sort(sorted.begin(), sorted.end());
  const double usual = sorted[(sorted.size() - 1) / 2];
  std::vector<FlatCorner> all;
  for (std::size_t i = 0; i < turns.size(); ++i) {
    const double steps = std::max(std::round(turns[i] / usual), 1.0);
    const bool is_even = std::abs(turns[i] / steps - usual) < kEvenTurn;
    if (!is_even && turns[i] > kWidestTurn) return {};
    const double count = is_even ? steps : 1.0;
    for (double k = 0.0; k < count; k += 1.0) {
      const double share = k / count;
      all.push_back({corners[i].angle + share * turns[i],
                     corners[i].radius + share * (corners[i + 1].radius - corners[i].radius)});
    }
  }
  return all;
}

double distance_from_sides(const std::vector<FlatCorner>& corners, const Flat& place) {
  double nearest = std::numeric_limits<double>::infinity();
  for (std::size_t i = 0; i < corners.size(); ++i) {
    const Flat from = corners[i].place();
    const Flat side = corners[(i + 1) % corners.size()].place() - from;
    const double along = std::clamp((place - from).dot(side) / side.squaredNorm(), 0.0, 1.0);
    nearest = std::min(nearest, (place - from - along * side).norm());
  }
  return nearest;
}

/// Whether the points of the wall are nearer to the polygon than to the circle.
bool explains_wall(const std::vector<FlatCorner>& corners, const Rim& rim, const Chart& chart,
                   const OrderedPoints& cloud, double spacing) {
  std::vector<spatial::Neighbour> near;
  cloud.within(chart.origin, rim.circle.radius + (kSidesEnd + kBesideCircle) * spacing, near);
  double from_polygon = 0.0, from_circle = 0.0;
  for (const auto& point : near) {
    const Vec3& place = cloud.position(point.index);
    const double height = about_axis(rim.circle, place).y() / spacing;
    if (height < kSidesBegin || height > kSidesEnd) continue;
    const Flat flat = chart.flat(place);
    const double out = std::abs(flat.norm() - rim.circle.radius) / spacing;
    if (out > kBesideCircle) continue;
    from_circle += out;
    from_polygon += std::min(distance_from_sides(corners, flat) / spacing, kBesideCircle);
  }
  return from_polygon < from_circle;
}

}  // namespace

std::vector<Vec3> corners_of_prism(const Rim& rim, const std::vector<Piece>& pieces,
                                   const EndIndex& ends, const OrderedPoints& cloud,
                                   double spacing) {
  const Chart chart(rim.circle.point, rim.circle.direction);
  std::vector<FlatCorner> corners = corners_seen(rim, chart, pieces, ends, spacing);
  if (corners.size() < kLeastSides || corners.size() > kMostSides) return {};
  corners = all_around(std::move(corners));
  if (corners.empty() || !explains_wall(corners, rim, chart, cloud, spacing)) return {};
  std::vector<Vec3> places;
  for (const FlatCorner& corner : corners) places.push_back(chart.place(corner.place()));
  return places;
}

}  // namespace pcednet::lines
