#include "pcednet/lines/exact_walls.h"

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <limits>
#include <optional>

#include "pcednet/lines/chart.h"
#include "pcednet/spatial/kd_tree.h"

namespace pcednet::lines {
namespace {

constexpr std::size_t kMostOnCircle = 12;        ///< places, to lay circles through
constexpr std::size_t kOnFirstWall[] = {12, 6};  ///< on a wall that grows; large ones go first
constexpr std::size_t kLeastOnWall = 6, kManyOnWall = 9;
constexpr std::size_t kLeastOnFacets = 12;
constexpr double kMostOfLean = 0.5;  ///< of the variance of the distances from a circle: the rest
constexpr std::size_t kNoWall = std::numeric_limits<std::size_t>::max();
constexpr std::size_t kMostRounds = 12;  ///< of the growth of a wall

/// What a wall's points lie on, and how near they are to its circle, each and as a root mean
/// square, in spacings.
struct WallKind {
  bool has_facets;
  double reach, most_error;
};
constexpr WallKind kCylinder{false, 0.01, 0.002}, kFacets{true, 0.03, 0.012};

// In spacings.
constexpr double kWallFrom = 0.05, kWallTo = 3.0;
constexpr double kLookForWall = 2.5;
constexpr double kNarrowRadius = 20.0;
constexpr double kLeastWallStep = 0.3;  ///< of the places that a circle is laid through
constexpr double kLeastWallRadius = 0.5, kMostWallRadius = 500.0;
/// Of the wall from its chord: others may be planes, and few points are on a flat arc by chance.
constexpr double kLeastWallRise = 0.15, kLeastWallRiseOfFew = 0.5, kLeastWallRiseOnFacets = 1.0;

/// Places beside a plane, seen along its normal and in spacings.
struct WallPoints {
  std::vector<std::uint32_t> indices;  ///< ascending
  std::vector<Vec3> places;            ///< z is 0
  std::vector<double> heights;         ///< from the plane
};

WallPoints seen_from(const OrderedPoints& cloud, const PlanePatch& plane, const Chart& chart,
                     double side, std::span<const std::uint32_t> points, double spacing) {
  WallPoints found;
  for (const std::uint32_t i : points) {
    const double height = side * plane.height(cloud.position(i)) / spacing;
    if (height < kWallFrom || height > kWallTo) continue;
    const Chart::Flat flat = chart.flat(cloud.position(i)) / spacing;
    found.indices.push_back(i);
    found.places.emplace_back(flat.x(), flat.y(), 0.0);
    found.heights.push_back(height);
  }
  return found;
}

struct WallCircle {
  Vec3 centre = Vec3::Zero();
  double radius = 0.0;
  WallKind kind = kCylinder;

  bool holds(const Vec3& place) const {
    return std::abs((place - centre).norm() - radius) < kind.reach;
  }
};

/// The circle through the origin and two places; none if they are near each other or on a line.
std::optional<WallCircle> circle_through(const Vec3& a, const Vec3& b, const WallKind& kind) {
  const double sq_a = a.squaredNorm(), sq_b = b.squaredNorm();
  if (std::min({sq_a, sq_b, (a - b).squaredNorm()}) < kLeastWallStep * kLeastWallStep) {
    return std::nullopt;
  }
  const double twice_area = a.x() * b.y() - a.y() * b.x();
  const Vec3 centre =
      Vec3(b.y() * sq_a - a.y() * sq_b, a.x() * sq_b - b.x() * sq_a, 0.0) / (2.0 * twice_area);
  const double radius = centre.norm();
  if (!(radius > kLeastWallRadius && radius < kMostWallRadius)) return std::nullopt;
  return WallCircle{centre, radius, kind};
}

/// Walls that grow from place to place.
class WallGrowth {
 public:
  explicit WallGrowth(const WallPoints& points)
      : points_(points),
        tree_(points.places),
        taken_(points.places.size(), 0),
        seen_(points.places.size(), 0) {}

  /// Grows a wall from this place if so many near it are on one.
  void try_at(std::uint32_t first, std::size_t least_on, const WallKind& kind);

  /// Makes one of the walls that are on one circle: there may be gaps between them.
  void unite();

  struct Wall {
    WallCircle circle;
    std::vector<std::uint32_t> members;
  };
  std::vector<Wall> found;

 private:
  bool set_first(std::uint32_t first, std::size_t least_on, const WallKind& kind);
  bool spread(std::uint32_t first);
  bool fit_to_members();
  double rise() const;
  bool leans() const;
  bool is_wall() const;
  bool is_on(const WallCircle& circle, const std::vector<std::uint32_t>& members) const;
  struct WallIndex {
    std::vector<Wall> walls;
    std::vector<std::size_t> wide;       ///< those of a large radius
    std::vector<std::size_t> of_places;  ///< the wall of each place
  };
  std::size_t wall_that_holds(const Wall& part, const WallIndex& index) const;

  const WallPoints& points_;
  spatial::KdTree tree_;
  std::vector<std::uint8_t> taken_;
  std::vector<std::uint32_t> seen_;  ///< in which spread() a place was last seen
  std::uint32_t spreads_ = 0;
  WallCircle circle_;
  double error_ = 0.0;
  std::vector<std::uint32_t> members_;
};

/// The circle through the place and two near it that the most of the free places there are on.
bool WallGrowth::set_first(std::uint32_t first, std::size_t least_on, const WallKind& kind) {
  const Vec3& at = points_.places[first];
  std::vector<spatial::Neighbour> near;
  tree_.within(at, kLookForWall, near);
  std::vector<Vec3> offsets;
  for (const auto& other : near) {
    if (other.index != first && !taken_[other.index]) {
      offsets.push_back(points_.places[other.index] - at);
    }
  }
  if (offsets.size() + 1 < least_on) return false;
  std::size_t most = least_on - 2;  // without the place itself
  const std::size_t step = (offsets.size() + kMostOnCircle - 1) / kMostOnCircle;
  bool is_set = false;
  for (std::size_t j = 0; j < offsets.size(); j += step) {
    for (std::size_t k = j + step; k < offsets.size(); k += step) {
      const auto circle = circle_through(offsets[j], offsets[k], kind);
      if (!circle) continue;
      const auto on = static_cast<std::size_t>(std::count_if(
          offsets.begin(), offsets.end(), [&](const Vec3& place) { return circle->holds(place); }));
      if (on <= most) continue;
      most = on;
      circle_ = {at + circle->centre, circle->radius, kind};
      is_set = true;
    }
  }
  return is_set;
}

bool WallGrowth::fit_to_members() {
  std::vector<Vec3> places;
  for (const std::uint32_t i : members_) places.push_back(points_.places[i]);
  const Fit fit = fit_arc(places, 1.0);
  if (fit.kind != CurveKind::kArc) return false;
  circle_ = {fit.point, fit.radius, circle_.kind};
  error_ = fit.error;
  return true;
}

/// Sets the members to the free places on the circle that hang together with the first one, and
/// the circle to theirs.
bool WallGrowth::spread(std::uint32_t first) {
  std::vector<spatial::Neighbour> near;
  ++spreads_;
  members_ = {first};
  seen_[first] = spreads_;
  std::size_t next_fit = 2 * kLeastOnWall;
  for (std::size_t k = 0; k < members_.size(); ++k) {
    tree_.within(points_.places[members_[k]], kLookForWall, near);
    for (const auto& other : near) {
      if (taken_[other.index] || seen_[other.index] == spreads_) continue;
      if (!circle_.holds(points_.places[other.index])) continue;
      seen_[other.index] = spreads_;
      members_.push_back(other.index);
    }
    if (members_.size() < next_fit) continue;
    if (!fit_to_members()) return false;
    next_fit = 2 * members_.size();
  }
  return members_.size() >= kLeastOnWall && fit_to_members();
}

/// How far the members are from one line.
double WallGrowth::rise() const {
  const Vec3& from = points_.places[members_.front()];
  double longest = 0.0;
  Vec3 to = from;
  for (const std::uint32_t i : members_) {
    const double length = (points_.places[i] - from).norm();
    if (length > longest) longest = length, to = points_.places[i];
  }
  const Vec3 along = (to - from).normalized();
  double least = 0.0, most = 0.0;
  for (const std::uint32_t i : members_) {
    const Vec3 offset = points_.places[i] - from;
    const double aside = along.x() * offset.y() - along.y() * offset.x();
    least = std::min(least, aside), most = std::max(most, aside);
  }
  return most - least;
}

/// Takes away from `values` what of them is proportional to `part`.
void take_away(const Eigen::ArrayXd& part, Eigen::ArrayXd& values) {
  const double square = part.square().sum();
  if (square > 0.0) values -= (values * part).sum() / square * part;
}

/// Whether the distances of the members from the circle follow from their heights, as on a cone or
/// a torus: on facets they do not.
bool WallGrowth::leans() const {
  const auto count = static_cast<Eigen::Index>(members_.size());
  Eigen::ArrayXd height(count), off(count);
  for (Eigen::Index k = 0; k < count; ++k) {
    const std::uint32_t i = members_[static_cast<std::size_t>(k)];
    height[k] = points_.heights[i];
    off[k] = (points_.places[i] - circle_.centre).norm() - circle_.radius;
  }
  off -= off.mean(), height -= height.mean();
  const double before = off.square().sum();
  take_away(height, off);
  Eigen::ArrayXd bow = height.square();
  bow -= bow.mean();
  take_away(height, bow), take_away(bow, off);
  const auto n = static_cast<double>(count);
  return off.square().sum() / (n - 3.0) < kMostOfLean * before / (n - 1.0);
}

/// Whether the members are enough, on a curve, and as near to it as they should be.
bool WallGrowth::is_wall() const {
  const WallKind& kind = circle_.kind;
  if (error_ > kind.most_error || circle_.radius < kLeastWallRadius) return false;
  if (kind.has_facets) {
    return members_.size() >= kLeastOnFacets && rise() > kLeastWallRiseOnFacets && !leans();
  }
  return rise() > (members_.size() < kManyOnWall ? kLeastWallRiseOfFew : kLeastWallRise);
}

void WallGrowth::try_at(std::uint32_t first, std::size_t least_on, const WallKind& kind) {
  if (taken_[first] || !set_first(first, least_on, kind)) return;
  // The circle through three places is wrong farther on; that of all so far is less so.
  for (std::size_t before = 0, round = 0; round < kMostRounds; ++round) {
    if (!spread(first)) return;
    if (round > 0 && members_.size() <= before) break;
    before = members_.size();
  }
  if (!is_wall()) return;
  for (const std::uint32_t i : members_) taken_[i] = 1;
  found.push_back({circle_, members_});
}

bool WallGrowth::is_on(const WallCircle& circle, const std::vector<std::uint32_t>& members) const {
  return std::ranges::all_of(members,
                             [&](std::uint32_t i) { return circle.holds(points_.places[i]); });
}

/// The number of a wall whose circle all members of this one are on; kNoWall if there is none. The
/// places of a narrow one are near each other.
std::size_t WallGrowth::wall_that_holds(const Wall& part, const WallIndex& index) const {
  for (const std::size_t wall : index.wide) {
    if (is_on(index.walls[wall].circle, part.members)) return wall;
  }
  std::vector<spatial::Neighbour> near;
  tree_.within(points_.places[part.members.front()], 2.0 * kNarrowRadius, near);
  std::size_t last = kNoWall;
  for (const auto& other : near) {
    const std::size_t wall = index.of_places[other.index];
    if (wall == kNoWall || wall == last) continue;
    if (is_on(index.walls[wall].circle, part.members)) return wall;
    last = wall;
  }
  return kNoWall;
}

void WallGrowth::unite() {
  std::stable_sort(found.begin(), found.end(), [](const Wall& a, const Wall& b) {
    return a.members.size() > b.members.size();
  });
  WallIndex whole{.walls = {},
                  .wide = {},
                  .of_places = std::vector<std::size_t>(points_.places.size(), kNoWall)};
  for (const Wall& part : found) {
    std::size_t wall = wall_that_holds(part, whole);
    if (wall == kNoWall) {
      wall = whole.walls.size();
      if (part.circle.radius > kNarrowRadius) whole.wide.push_back(wall);
      whole.walls.push_back(part);
    } else {
      circle_ = whole.walls[wall].circle;
      members_ = std::move(whole.walls[wall].members);
      members_.insert(members_.end(), part.members.begin(), part.members.end());
      if (fit_to_members()) whole.walls[wall].circle = circle_;
      whole.walls[wall].members = members_;
    }
    for (const std::uint32_t i : part.members) whole.of_places[i] = wall;
  }
  for (Wall& wall : whole.walls) std::sort(wall.members.begin(), wall.members.end());
  found = std::move(whole.walls);
}

}  // namespace

std::vector<ExactWall> find_exact_walls(const OrderedPoints& cloud, const PlanePatch& plane,
                                        std::span<const std::uint32_t> points, double spacing) {
  std::vector<ExactWall> walls;
  const Chart chart(
      cloud.position(points.front()) - plane.height(cloud.position(points.front())) * plane.normal,
      plane.normal);
  for (const double side : {1.0, -1.0}) {
    const WallPoints flat = seen_from(cloud, plane, chart, side, points, spacing);
    if (flat.indices.size() < kLeastOnWall) continue;
    WallGrowth growth(flat);
    for (const WallKind& kind : {kCylinder, kFacets}) {
      for (const std::size_t least_on : kOnFirstWall) {
        for (std::uint32_t i = 0; i < flat.indices.size(); ++i) {
          growth.try_at(i, least_on, kind);
        }
      }
    }
    growth.unite();
    for (const WallGrowth::Wall& wall : growth.found) {
      const Chart::Flat centre = spacing * wall.circle.centre.head<2>();
      ExactWall& exact = walls.emplace_back();
      exact.circle = {CurveKind::kArc, chart.place(centre), side * plane.normal,
                      spacing * wall.circle.radius, 0.0};
      exact.reach = spacing * wall.circle.kind.reach;
      for (const std::uint32_t i : wall.members) exact.members.push_back(flat.indices[i]);
    }
  }
  return walls;
}

}  // namespace pcednet::lines
