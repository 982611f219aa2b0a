#include "pcednet/lines/exact/cylinders.h"

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <limits>
#include <optional>

#include "pcednet/lines/points/chart.h"
#include "pcednet/spatial/kd_tree.h"

namespace pcednet::lines {
namespace {

constexpr std::size_t kMostOnCircle = 12;  ///< places, to lay circles through
/// Points on a circle from which a cylinder grows: large ones go first.
constexpr std::size_t kOnFirstCylinder[] = {12, 6};
constexpr std::size_t kLeastOnCylinder = 6, kManyOnCylinder = 9;
constexpr std::size_t kLeastOnFacets = 12;
constexpr double kMostOfLean = 0.5;  ///< of the variance of the distances from a circle: the rest
constexpr std::size_t kNoCylinder = std::numeric_limits<std::size_t>::max();
constexpr std::size_t kMostRounds = 12;  ///< of the growth of a cylinder
constexpr std::size_t kFirstBetweenLooks = 256, kMembersBetweenLooks = 256;
constexpr double kPartOfFacets = 1.5;  ///< as many points on facets: the cylinder is part of them

/// What a cylinder's points lie on, and how near they are to its circle, each and as a root mean
/// square, in spacings.
struct CylinderKind {
  bool has_facets;
  double reach, most_error;
};
constexpr CylinderKind kCylinder{false, 0.01, 0.002}, kFacets{true, 0.03, 0.012};

// In spacings.
constexpr double kCylinderFrom = 0.05, kCylinderTo = 3.0;
constexpr double kLookForCylinder = 2.5;
constexpr double kNarrowRadius = 20.0;
constexpr double kLeastCylinderStep = 0.3;  ///< of the places that a circle is laid through
constexpr double kLeastCylinderRadius = 0.5, kMostCylinderRadius = 500.0;
/// A flatter arc may be a plane, and few points are on one by chance.
constexpr double kLeastCylinderRise = 0.15, kLeastCylinderRiseOfFew = 0.5,
                 kLeastCylinderRiseOnFacets = 1.0;

/// Places beside a plane, seen along its normal and in spacings.
struct CylinderPoints {
  std::vector<std::uint32_t> indices;  ///< ascending
  std::vector<Vec3> places;            ///< z is 0
  std::vector<double> heights;         ///< from the plane
};

CylinderPoints seen_from(const OrderedPoints& cloud, const PlanePatch& plane, const Chart& chart,
                         double side, std::span<const std::uint32_t> points, double spacing) {
  CylinderPoints found;
  for (const std::uint32_t i : points) {
    const double height = side * plane.height(cloud.position(i)) / spacing;
    if (height < kCylinderFrom || height > kCylinderTo) continue;
    const Chart::Flat flat = chart.flat(cloud.position(i)) / spacing;
    found.indices.push_back(i);
    found.places.emplace_back(flat.x(), flat.y(), 0.0);
    found.heights.push_back(height);
  }
  return found;
}

struct CylinderCircle {
  Vec3 centre = Vec3::Zero();
  double radius = 0.0;
  CylinderKind kind = kCylinder;

  double off(const Vec3& place) const { return std::abs((place - centre).norm() - radius); }
  bool holds(const Vec3& place) const { return off(place) < kind.reach; }
};

/// The circle through the origin and two places; none if they are near each other or on a line.
std::optional<CylinderCircle> circle_through(const Vec3& a, const Vec3& b,
                                             const CylinderKind& kind) {
  const double sq_a = a.squaredNorm(), sq_b = b.squaredNorm();
  if (std::min({sq_a, sq_b, (a - b).squaredNorm()}) < kLeastCylinderStep * kLeastCylinderStep) {
    return std::nullopt;
  }
  const double twice_area = a.x() * b.y() - a.y() * b.x();
  const Vec3 centre =
      Vec3(b.y() * sq_a - a.y() * sq_b, a.x() * sq_b - b.x() * sq_a, 0.0) / (2.0 * twice_area);
  const double radius = centre.norm();
  if (!(radius > kLeastCylinderRadius && radius < kMostCylinderRadius)) return std::nullopt;
  return CylinderCircle{centre, radius, kind};
}

/// Cylinders that grow from place to place.
class CylinderGrowth {
 public:
  CylinderGrowth(const CylinderPoints& points, const Progress* progress)
      : points_(points),
        progress_(progress),
        tree_(points.places),
        taken_(points.places.size(), 0),
        seen_(points.places.size(), 0) {}

  /// Grows a cylinder from this place if `least_on` places near it are on one.
  void try_at(std::uint32_t first, std::size_t least_on, const CylinderKind& kind);

  /// Makes one of the cylinders that are on one circle: there may be gaps between them.
  void unite();

  struct Cylinder {
    CylinderCircle circle;
    std::vector<std::uint32_t> members;
  };
  std::vector<Cylinder> found;

 private:
  bool set_first(std::uint32_t first, std::size_t least_on, const CylinderKind& kind);
  bool spread(std::uint32_t first);
  bool fit_to_members();
  double rise() const;
  bool leans() const;
  bool is_cylinder() const;
  bool grow(std::uint32_t first);
  void grow_over_facets(std::uint32_t first);
  bool is_on(const CylinderCircle& circle, const std::vector<std::uint32_t>& members) const;
  struct CylinderIndex {
    std::vector<Cylinder> cylinders;
    std::vector<std::size_t> wide;       ///< those of a large radius
    std::vector<std::size_t> of_places;  ///< the cylinder of each place
  };
  std::size_t cylinder_that_holds(const Cylinder& part, const CylinderIndex& index) const;
  bool add(const Cylinder& part, Cylinder& whole);

  const CylinderPoints& points_;
  const Progress* progress_;
  spatial::KdTree tree_;
  std::vector<std::uint8_t> taken_;
  std::vector<std::uint32_t> seen_;  ///< in which spread() a place was last seen
  std::uint32_t spreads_ = 0;
  CylinderCircle circle_;
  double error_ = 0.0;
  std::vector<std::uint32_t> members_;
};

/// The circle through the place and two near it that the most of the free places there are on.
bool CylinderGrowth::set_first(std::uint32_t first, std::size_t least_on,
                               const CylinderKind& kind) {
  const Vec3& at = points_.places[first];
  std::vector<spatial::Neighbour> near;
  tree_.within(at, kLookForCylinder, near);
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

bool CylinderGrowth::fit_to_members() {
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
bool CylinderGrowth::spread(std::uint32_t first) {
  std::vector<spatial::Neighbour> near;
  ++spreads_;
  members_ = {first};
  seen_[first] = spreads_;
  std::size_t next_fit = 2 * kLeastOnCylinder;
  for (std::size_t k = 0; k < members_.size(); ++k) {
    if (k % kMembersBetweenLooks == 0) throw_if_cancelled(progress_);
    tree_.within(points_.places[members_[k]], kLookForCylinder, near);
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
  return members_.size() >= kLeastOnCylinder && fit_to_members();
}

/// How far the members are from one line.
double CylinderGrowth::rise() const {
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
bool CylinderGrowth::leans() const {
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
bool CylinderGrowth::is_cylinder() const {
  const CylinderKind& kind = circle_.kind;
  if (error_ > kind.most_error || circle_.radius < kLeastCylinderRadius) return false;
  if (kind.has_facets) {
    return members_.size() >= kLeastOnFacets && rise() > kLeastCylinderRiseOnFacets && !leans();
  }
  return rise() >
         (members_.size() < kManyOnCylinder ? kLeastCylinderRiseOfFew : kLeastCylinderRise);
}

/// Grows a cylinder from the circle that is set. The circle through three places is wrong farther
/// on; that of all so far is less so.
bool CylinderGrowth::grow(std::uint32_t first) {
  for (std::size_t before = 0, round = 0; round < kMostRounds; ++round) {
    if (!spread(first)) return false;
    if (round > 0 && members_.size() <= before) break;
    before = members_.size();
  }
  return is_cylinder();
}

/// A cylinder of low facets holds together only within their reach.
void CylinderGrowth::grow_over_facets(std::uint32_t first) {
  const Cylinder part{circle_, members_};
  circle_.kind = kFacets;
  const double least = kPartOfFacets * static_cast<double>(part.members.size());
  if (grow(first) && static_cast<double>(members_.size()) >= least) return;
  circle_ = part.circle;
  members_ = part.members;
}

void CylinderGrowth::try_at(std::uint32_t first, std::size_t least_on, const CylinderKind& kind) {
  if (taken_[first] || !set_first(first, least_on, kind) || !grow(first)) return;
  if (!kind.has_facets) grow_over_facets(first);
  for (const std::uint32_t i : members_) taken_[i] = 1;
  found.push_back({circle_, members_});
}

bool CylinderGrowth::is_on(const CylinderCircle& circle,
                           const std::vector<std::uint32_t>& members) const {
  return std::ranges::all_of(
      members, [&](std::uint32_t i) { return circle.off(points_.places[i]) < kFacets.reach; });
}

/// The number of a cylinder whose circle all members of this one are on; kNoCylinder if there is
/// none. The places of a narrow one are near each other.
std::size_t CylinderGrowth::cylinder_that_holds(const Cylinder& part,
                                                const CylinderIndex& index) const {
  for (const std::size_t cylinder : index.wide) {
    if (is_on(index.cylinders[cylinder].circle, part.members)) return cylinder;
  }
  std::vector<spatial::Neighbour> near;
  tree_.within(points_.places[part.members.front()], 2.0 * kNarrowRadius, near);
  std::size_t last = kNoCylinder;
  for (const auto& other : near) {
    const std::size_t cylinder = index.of_places[other.index];
    if (cylinder == kNoCylinder || cylinder == last) continue;
    if (is_on(index.cylinders[cylinder].circle, part.members)) return cylinder;
    last = cylinder;
  }
  return kNoCylinder;
}

/// Adds the part to a cylinder unless one circle is too far from both.
bool CylinderGrowth::add(const Cylinder& part, Cylinder& whole) {
  circle_ = whole.circle;
  members_ = whole.members;
  members_.insert(members_.end(), part.members.begin(), part.members.end());
  if (!fit_to_members() || error_ > kFacets.most_error) return false;
  if (error_ > kCylinder.most_error) circle_.kind = kFacets;
  whole = {circle_, members_};
  return true;
}

void CylinderGrowth::unite() {
  std::stable_sort(found.begin(), found.end(), [](const Cylinder& a, const Cylinder& b) {
    return a.members.size() > b.members.size();
  });
  CylinderIndex whole{.cylinders = {},
                      .wide = {},
                      .of_places = std::vector<std::size_t>(points_.places.size(), kNoCylinder)};
  for (const Cylinder& part : found) {
    std::size_t cylinder = cylinder_that_holds(part, whole);
    if (cylinder == kNoCylinder || !add(part, whole.cylinders[cylinder])) {
      cylinder = whole.cylinders.size();
      if (part.circle.radius > kNarrowRadius) whole.wide.push_back(cylinder);
      whole.cylinders.push_back(part);
    }
    for (const std::uint32_t i : part.members) whole.of_places[i] = cylinder;
  }
  for (Cylinder& cylinder : whole.cylinders)
    std::sort(cylinder.members.begin(), cylinder.members.end());
  found = std::move(whole.cylinders);
}

}  // namespace

std::vector<ExactCylinder> find_exact_cylinders(const OrderedPoints& cloud, const PlanePatch& plane,
                                                std::span<const std::uint32_t> points,
                                                double spacing, const Progress* progress) {
  std::vector<ExactCylinder> cylinders;
  const Chart chart(
      cloud.position(points.front()) - plane.height(cloud.position(points.front())) * plane.normal,
      plane.normal);
  for (const double side : {1.0, -1.0}) {
    const CylinderPoints flat = seen_from(cloud, plane, chart, side, points, spacing);
    if (flat.indices.size() < kLeastOnCylinder) continue;
    CylinderGrowth growth(flat, progress);
    for (const CylinderKind& kind : {kCylinder, kFacets}) {
      for (const std::size_t least_on : kOnFirstCylinder) {
        for (std::uint32_t i = 0; i < flat.indices.size(); ++i) {
          if (i % kFirstBetweenLooks == 0) throw_if_cancelled(progress);
          growth.try_at(i, least_on, kind);
        }
      }
    }
    growth.unite();
    for (const CylinderGrowth::Cylinder& cylinder : growth.found) {
      const Chart::Flat centre = spacing * cylinder.circle.centre.head<2>();
      ExactCylinder& exact = cylinders.emplace_back();
      exact.circle = {CurveKind::kArc, chart.place(centre), side * plane.normal,
                      spacing * cylinder.circle.radius, 0.0};
      exact.reach = spacing * cylinder.circle.kind.reach;
      for (const std::uint32_t i : cylinder.members) exact.members.push_back(flat.indices[i]);
    }
  }
  return cylinders;
}

}  // namespace pcednet::lines
