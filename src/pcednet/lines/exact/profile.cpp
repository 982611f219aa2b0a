#include "pcednet/lines/exact/profile.h"

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <span>

#include "pcednet/lines/curves/curve.h"
#include "pcednet/lines/exact/fillet.h"
#include "pcednet/lines/exact/fold_search.h"
#include "pcednet/lines/pieces/observe.h"
#include "pcednet/spatial/opening.h"

namespace pcednet::lines {
namespace {

constexpr double kOpenShare = 0.35;  ///< of a circle

// In spacings.
constexpr double kOpenLength = 2.5;                   ///< of a circle
constexpr double kBesideGap = 1.5, kBeforeGap = 0.5;  ///< of points that are of neither surface
constexpr double kOffRays = 0.05;
constexpr double kLeastRiseOfArc = 0.15;  ///< from its chord

/// The direction in the middle of the largest gap between the cylinder's points about its axis.
Vec3 middle_of_gap(const OrderedPoints& cloud, const ExactCylinder& cylinder) {
  const Vec3 x = cylinder.circle.direction.unitOrthogonal(), y = cylinder.circle.direction.cross(x);
  std::vector<double> angles;
  for (const std::uint32_t i : cylinder.members) {
    angles.push_back(angle_at(cylinder.circle, x, cloud.position(i)));
  }
  const double middle = spatial::widest_opening(angles).middle;
  return std::cos(middle) * x + std::sin(middle) * y;
}

/// The intervals of the first of two turns, or the one that goes all around.
std::vector<Interval> in_one_turn(const std::vector<Interval>& intervals, double radius) {
  const double around = kWholeTurn * radius;
  double known = 0.0;  // where the last that goes on beyond the first turn ends in the next
  for (const Interval& interval : intervals) {
    if (interval.length() >= around) return {{interval.from, interval.from + around}};
    if (interval.from < around && interval.to > around) known = interval.to - around;
  }
  std::vector<Interval> found;
  for (const Interval& interval : intervals) {
    if (interval.from < around && interval.to > known) found.push_back(interval);
  }
  return found;
}

}  // namespace

Profile::Profile(const OrderedPoints& cloud, const ExactCylinder& cylinder, double spacing)
    : cloud_(cloud),
      circle_(cylinder.circle),
      spacing_(spacing),
      on_ray_(cylinder.reach / spacing) {
  start_ = middle_of_gap(cloud, cylinder);
  left_ = circle_.direction.cross(start_);
  for (const std::uint32_t i : indices_around(cylinder)) {
    const Vec3& position = cloud.position(i);
    points_.push_back({i, angle_of(position), about_axis(circle_, position) / spacing});
  }
}

double Profile::angle_of(const Vec3& place) const {
  const double angle = angle_at(circle_, start_, place);
  return angle < 0.0 ? angle + kWholeTurn : angle;
}

Vec3 Profile::out_at(double angle) const {
  return std::cos(angle) * start_ + std::sin(angle) * left_;
}

/// Those near the circle, each once, in curve order: all around it if the members of the cylinder
/// go half around, else as far as they go and a gap beyond.
std::vector<std::uint32_t> Profile::indices_around(const ExactCylinder& cylinder) const {
  double first = kWholeTurn, last = 0.0;
  for (const std::uint32_t i : cylinder.members) {
    const double angle = angle_of(cloud_.position(i));
    first = std::min(first, angle), last = std::max(last, angle);
  }
  const double step = spacing_ / circle_.radius;
  const bool is_round = last - first > 0.5 * kWholeTurn;
  const double beyond = is_round ? 0.5 * kWholeTurn : kLongestStripGap * step;
  const double end = std::min(last + beyond, first - beyond + kWholeTurn);
  std::vector<Vec3> places;
  for (double angle = first - beyond; angle < end; angle += step) {
    places.push_back(circle_.point + circle_.radius * out_at(angle));
  }
  return cloud_.near_any(places, (kStripWidth + 1.0) * spacing_);
}

/// The points on the ray, by their places along the circle through its beginning: two turns of it,
/// so that no interval ends where angles begin.
Strip Profile::strip_along(const ProfileRay& ray) const {
  std::vector<PlaceBeside> places;
  for (const Point& point : points_) {
    if (ray.off(point.at) > on_ray_) continue;
    for (const double turns : {0.0, kWholeTurn}) {
      places.push_back({(point.angle + turns) * ray.from.x(), ray.along(point.at)});
    }
  }
  return strip_of(places);
}

double Profile::mean_probability(const Interval& interval, const Eigen::Vector2d& at) const {
  double sum = 0.0, count = 0.0;
  for (const Point& point : points_) {
    double along = point.angle * at.x();
    if (along < interval.from) along += kWholeTurn * at.x();
    if (along < interval.from || along > interval.to || (point.at - at).norm() > kAtExactEdge)
      continue;
    sum += static_cast<double>(cloud_.probability(point.index));
    count += 1.0;
  }
  return count > 0.0 ? sum / count : 0.0;
}

Piece Profile::piece_along(const Interval& interval, const ProfileRay& a,
                           const ProfileRay& b) const {
  const Eigen::Vector2d& at = a.from;
  Piece piece{.fit = circle_, .nodes = {}, .ends = {}, .exact = true};
  piece.fit.radius = spacing_ * at.x();
  piece.fit.point += spacing_ * at.y() * circle_.direction;
  const double around = kWholeTurn * at.x();
  piece.closed = around - interval.length() < std::min(kOpenLength, kOpenShare * around);
  const Interval drawn = piece.closed ? Interval{0.0, around} : interval;
  const auto place = [&](double along) -> Vec3 {
    return piece.fit.point + piece.fit.radius * out_at(along / at.x());
  };
  const auto count = static_cast<std::size_t>(std::ceil(drawn.length()));
  for (std::size_t k = 0; k < count; ++k) {
    const double share = (static_cast<double>(k) + 0.5) / static_cast<double>(count);
    const double along = drawn.from + share * drawn.length();
    const Vec3 out = out_at(along / at.x());
    const auto in_space = [&](const Eigen::Vector2d& side) -> Vec3 {
      return side.x() * out + side.y() * circle_.direction;
    };
    ChainNode node{.at = place(along),
                   .along = circle_.direction.cross(out),
                   .side_a = in_space(a.direction),
                   .side_b = in_space(b.direction),
                   .spacing = spacing_};
    observe(node, cloud_);
    piece.nodes.push_back(node);
  }
  piece.ends = {place(interval.from), place(interval.to)};
  if (piece.closed) piece.ends = {piece.nodes.front().at, piece.nodes.front().at};
  return piece;
}

/// Intervals of two turns as one where nothing but the two surfaces is near the gap: a notch has
/// sides.
std::vector<Interval> Profile::bridged(const std::vector<Interval>& intervals, const ProfileRay& a,
                                       const ProfileRay& b) const {
  std::vector<double> strays;  // along the circle
  for (const Point& point : points_) {
    if ((point.at - a.from).norm() > kBesideGap) continue;
    if (a.is_near(point.at, kOffRays) || b.is_near(point.at, kOffRays)) continue;
    for (const double turns : {0.0, kWholeTurn}) {
      strays.push_back((point.angle + turns) * a.from.x());
    }
  }
  std::vector<Interval> whole;
  for (const Interval& part : intervals) {
    const double from = whole.empty() ? 0.0 : whole.back().to;
    const bool is_stray = std::ranges::any_of(strays, [&](double along) {
      return along > from - kBeforeGap && along < part.from + kBeforeGap;
    });
    if (whole.empty() || part.from - from > kLongestStripGap || is_stray) {
      whole.push_back(part);
    } else {
      whole.back().to = part.to;
    }
  }
  return whole;
}

std::vector<Piece> Profile::arcs(const ProfileRay& a, const ProfileRay& b) const {
  const double sine = a.direction.x() * b.direction.y() - a.direction.y() * b.direction.x();
  if (std::abs(sine) < kLeastSineOfFold) return {};
  const Strip of_a = strip_along(a), of_b = strip_along(b);
  std::vector<Piece> found;
  for (const Interval& interval :
       in_one_turn(bridged(shared_intervals(of_a, of_b), a, b), a.from.x())) {
    if (interval.length() < kLeastExactLength) continue;
    if (!end_at_line(of_a, of_b, interval)) continue;
    if (mean_probability(interval, a.from) < kLeastExactProbability) continue;
    Piece piece = piece_along(interval, a, b);
    const double rise = interval.length() * interval.length() / (8.0 * a.from.x());
    if (piece.closed || rise > kLeastRiseOfArc) found.push_back(std::move(piece));
  }
  return found;
}

std::vector<Piece> Profile::fillets(const ProfileRay& a, const ProfileRay& b) const {
  const Eigen::Vector2d half_way = (a.direction + b.direction).normalized(),
                        across = (a.direction - b.direction).normalized();
  std::vector<CornerPoint> corner;  // of two turns, as in strip_along()
  for (const Point& point : points_) {
    const Eigen::Vector2d offset = point.at - a.from;
    for (const double turns : {0.0, kWholeTurn}) {
      corner.push_back(
          {(point.angle + turns) * a.from.x(), {offset.dot(half_way), offset.dot(across)}});
    }
  }
  const auto fillet = find_fillet(corner, std::acos(a.direction.dot(half_way)));
  if (!fillet) return {};
  const Eigen::Vector2d middle = a.from + fillet->depth * half_way;
  std::vector<Piece> found;
  for (const Interval& interval : in_one_turn(fillet->intervals, a.from.x())) {
    const double stretch = middle.x() / a.from.x();
    Piece piece = piece_along({stretch * interval.from, stretch * interval.to},
                              {middle, a.direction}, {middle, b.direction});
    piece.rounded = true;
    found.push_back(std::move(piece));
  }
  return found;
}

double Profile::turn_along(const ProfileRay& ray) const {
  double length = 0.0;
  const Strip strip = strip_along(ray);
  for (const Interval& interval : in_one_turn(shared_intervals(strip, strip), ray.from.x())) {
    length += interval.length();
  }
  return length / ray.from.x();
}

}  // namespace pcednet::lines
