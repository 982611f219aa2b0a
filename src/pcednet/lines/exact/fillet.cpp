#include "pcednet/lines/exact/fillet.h"

#include <algorithm>
#include <cmath>
#include <numbers>

#include "pcednet/lines/points/moments.h"

namespace pcednet::lines {
namespace {

constexpr std::size_t kMostLaidThrough = 24;  ///< points, to lay arcs through
constexpr double kLeastOnArc = 6.0;           ///< points
constexpr double kDenseFillet = 0.2;  ///< points on the arc, to a square spacing of the fillet
constexpr double kMostBeside = 0.15;  ///< points in the corner off the arc, to one on it
constexpr double kFlat = 2.0;         ///< square distance from a line, to that from the arc
constexpr double kLeastOnLine = 0.2;  ///< points on each line beyond the arc, to a spacing
constexpr double kPointsToEnd = 4.0;  ///< of an arc: fewer are missing by chance

// In spacings.
constexpr double kOffLines = 0.02;
constexpr double kOnArc = 0.005, kOnArcOfRadius = 0.02;  ///< the second to a spacing of the radius
constexpr double kLeastRadius = 0.2, kMostTangent = 2.2;
constexpr double kWithinTangents = 0.1;
constexpr double kBeyondTangents = 1.0;

/// The corner of two lines, and the arcs that touch both.
class Corner {
 public:
  explicit Corner(double half_angle) : sine_(std::sin(half_angle)), cosine_(std::cos(half_angle)) {}

  double tangent_of(double radius) const { return radius * cosine_ / sine_; }
  double depth_of(double radius) const { return radius * (1.0 / sine_ - 1.0); }
  /// The angle over which the arc turns.
  double turn() const { return std::numbers::pi - 2.0 * std::asin(sine_); }

  /// The distance of a place from the nearer line, below 0 outside of the corner.
  double depth_at(const Eigen::Vector2d& at) const {
    return at.x() * sine_ - std::abs(at.y()) * cosine_;
  }
  /// How far along the nearer line the place is, from the corner.
  double far_along(const Eigen::Vector2d& at) const {
    return at.x() * cosine_ + std::abs(at.y()) * sine_;
  }
  /// The radius of the arc that passes the place on its way from line to line.
  double radius_through(const Eigen::Vector2d& at) const {
    const double sq_sine_of = at.y() * at.y() / at.squaredNorm();
    const double root = std::sqrt(std::max(0.0, sine_ * sine_ - sq_sine_of));
    return at.norm() * sine_ * (std::sqrt(1.0 - sq_sine_of) + root) / (cosine_ * cosine_);
  }
  double off_arc(const Eigen::Vector2d& at, double radius) const {
    return std::abs((at - Eigen::Vector2d(radius / sine_, 0.0)).norm() - radius);
  }

 private:
  double sine_, cosine_;
};

bool is_on_arc(const Corner& corner, const Eigen::Vector2d& at, double radius) {
  return corner.off_arc(at, radius) < kOnArc + kOnArcOfRadius * radius &&
         corner.far_along(at) < corner.tangent_of(radius);
}

/// The radius of the arc that the most of the places off the lines are on.
std::optional<double> radius_of(const Corner& corner, std::span<const CornerPoint> points) {
  std::vector<Eigen::Vector2d> free;
  for (const CornerPoint& point : points) {
    if (corner.depth_at(point.at) > kOffLines) free.push_back(point.at);
  }
  const std::size_t step = (free.size() + kMostLaidThrough - 1) / kMostLaidThrough;
  std::optional<double> best;
  auto most = static_cast<std::ptrdiff_t>(kLeastOnArc) - 1;
  for (std::size_t i = 0; i < free.size(); i += step) {
    const double radius = corner.radius_through(free[i]);
    if (radius < kLeastRadius || corner.tangent_of(radius) > kMostTangent) continue;
    const auto on = std::ranges::count_if(
        free, [&](const Eigen::Vector2d& at) { return is_on_arc(corner, at, radius); });
    if (on > most) most = on, best = radius;
  }
  return best;
}

/// Whether the points of the arc are on a line across the corner rather than on the arc.
bool is_chamfer(const Corner& corner, double radius, std::span<const CornerPoint> points) {
  FlatMoments on;
  double sq_off_arc = 0.0;
  for (const auto& [along, at] : points) {
    if (corner.depth_at(at) < kOffLines || !is_on_arc(corner, at, radius)) continue;
    on.add(at);
    sq_off_arc += std::pow(corner.off_arc(at, radius), 2);
  }
  const Eigen::Matrix2d spread = on.count * on.covariance();
  const double sq_off_line = spread(0, 0) - spread(0, 1) * spread(0, 1) / spread(1, 1);
  return !(sq_off_line > kFlat * sq_off_arc);
}

/// The points beside an arc: along the edge, ascending.
struct Beside {
  std::vector<double> on;         ///< on the arc, off the lines
  std::vector<double> off;        ///< in the corner, not on the arc
  std::vector<double> beyond[2];  ///< on each line, beyond the arc
};

Beside points_beside(const Corner& corner, double radius, std::span<const CornerPoint> points) {
  const double tangent = corner.tangent_of(radius);
  Beside beside;
  for (const auto& [along, at] : points) {
    const double depth = corner.depth_at(at), far = corner.far_along(at);
    if (depth < -kOffLines) continue;
    if (is_on_arc(corner, at, radius)) {
      if (depth > kOffLines) beside.on.push_back(along);
    } else if (far < tangent - kWithinTangents) {
      beside.off.push_back(along);
    } else if (far > tangent && far < tangent + kBeyondTangents && depth < kOffLines) {
      beside.beyond[at.y() < 0.0 ? 1 : 0].push_back(along);
    }
  }
  for (auto* row : {&beside.on, &beside.off, &beside.beyond[0], &beside.beyond[1]}) {
    std::sort(row->begin(), row->end());
  }
  return beside;
}

/// The interval up to where both lines end, if that may be by chance: few points are on a small
/// arc.
Interval extended(const Interval& interval, const Beside& beside) {
  const double apart = interval.length() / count_in(beside.on, interval);
  const double reach = kPointsToEnd * apart;
  double from = interval.from - reach, to = interval.to + reach;
  for (const std::vector<double>& row : beside.beyond) {
    const auto first = std::ranges::lower_bound(row, from),
               last = std::ranges::upper_bound(row, to);
    if (first == last) return interval;
    from = *first, to = *(last - 1);
  }
  return {std::min(from, interval.from), std::max(to, interval.to)};
}

bool is_fillet(const Interval& interval, double width, const Beside& beside) {
  const auto count = [&](const std::vector<double>& row) { return count_in(row, interval); };
  const double on = count(beside.on);
  return on >= std::max(kLeastOnArc, kDenseFillet * width * interval.length()) &&
         count(beside.off) <= kMostBeside * on &&
         std::ranges::all_of(beside.beyond, [&](const std::vector<double>& row) {
           return count(row) >= std::max(2.0, kLeastOnLine * interval.length());
         });
}

}  // namespace

std::optional<Fillet> find_fillet(std::span<const CornerPoint> points, double half_angle) {
  const Corner corner(half_angle);
  const auto radius = radius_of(corner, points);
  if (!radius || is_chamfer(corner, *radius, points)) return std::nullopt;
  const Beside beside = points_beside(corner, *radius, points);
  const double width = corner.turn() * *radius;
  Fillet fillet{*radius, corner.depth_of(*radius), {}};
  for (const Interval& interval : intervals_of(beside.on, kLongestStripGap)) {
    const Interval whole = extended(interval, beside);
    if (is_fillet(whole, width, beside)) fillet.intervals.push_back(whole);
  }
  if (fillet.intervals.empty()) return std::nullopt;
  return fillet;
}

}  // namespace pcednet::lines
