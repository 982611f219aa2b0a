#include "pcednet/lines/exact/planes.h"

#include <Eigen/Geometry>
#include <algorithm>
#include <limits>
#include <map>
#include <optional>

#include "pcednet/core/eigendecomposition.h"
#include "pcednet/lines/exact/density.h"
#include "pcednet/lines/points/plane_sums.h"

namespace pcednet::lines {
namespace {

constexpr double kProbable = 0.05;        ///< probability of an edge near which planes are sought
constexpr std::size_t kMostThrough = 10;  ///< of the nearest, to lay planes through
constexpr std::size_t kOnFirst[] = {12, 6};  ///< points on a plane that grows; large ones go first
constexpr std::size_t kLeastMembers = 8, kManyMembers = 64;
constexpr double kLeastSineBetween = 0.25;  ///< of two places seen from a third
constexpr double kReachOfPlane = 0.01;      ///< spacings
constexpr double kMostResidual = 0.1;       ///< root mean square, to the reach
/// Members this near, as shares of the reach, are surely on the plane; one after the other.
constexpr double kCores[] = {0.4, 0.2, 0.1};
constexpr double kLeastInCore = 0.7;      ///< of the members
constexpr double kLeastPatchWidth = 0.2;  ///< of the members, standard deviation in spacings
constexpr double kOneNormal = 0.999;      ///< cosine of patches that may be of one plane
// Of the points on a plane that the surface crosses: those between others off it, and on a line.
constexpr double kLeastAmid = 0.8, kLeastOnLines = 0.2;
constexpr double kNarrowest = 0.07;       ///< of a place on a plane, across to along, variances
constexpr std::size_t kFewNearby = 6;     ///< on the plane, and off it
constexpr std::size_t kLeastOfCore = 24;  ///< members: fewer may be of a curved surface
constexpr std::size_t kSeedsBetweenLooks = 1024;
constexpr std::uint32_t kNoRow = std::numeric_limits<std::uint32_t>::max();

/// The points near probable edges, and the nearest others of each.
struct Candidates {
  std::vector<std::uint32_t> points;  ///< ascending
  std::vector<std::uint32_t> rows;    ///< of each point of the cloud: its place among these
  std::vector<std::uint32_t> others;
  std::size_t others_of_each;
  std::vector<std::uint8_t> too_dense;  ///< by row

  std::span<const std::uint32_t> near(std::uint32_t row) const {
    return std::span(others).subspan(row * others_of_each, others_of_each);
  }
};

/// The nearest others of each point, row after row.
std::vector<std::uint32_t> others_of(const OrderedPoints& cloud,
                                     std::span<const std::uint32_t> points, Stage& stage) {
  const std::size_t count = cloud.available(kNearby);
  std::vector<std::uint32_t> found(points.size() * count);
  cloud.for_each_neighbourhood(points, kNearby, stage,
                               [&](std::size_t k, std::span<const spatial::Neighbour> others) {
                                 for (std::size_t m = 0; m < others.size(); ++m) {
                                   found[k * count + m] = others[m].index;
                                 }
                               });
  return found;
}

/// Marks the rows of points that are too dense.
std::vector<std::uint8_t> too_dense(const OrderedPoints& cloud, const Candidates& candidates,
                                    double spacing) {
  std::vector<std::uint8_t> marks(candidates.points.size(), 0);
  if (candidates.others_of_each < kNearby) return marks;
  for (std::uint32_t row = 0; row < marks.size(); ++row) {
    const Vec3& at = cloud.position(candidates.points[row]);
    const Vec3& last = cloud.position(candidates.near(row).back());
    marks[row] = is_too_dense((last - at).squaredNorm(), spacing) ? 1 : 0;
  }
  return marks;
}

Candidates find_candidates(const OrderedPoints& cloud, double spacing, const Progress* progress) {
  std::vector<std::uint32_t> probable;
  for (std::uint32_t i = 0; i < cloud.size(); ++i) {
    if (cloud.is_edge(i) || cloud.probability(i) >= kProbable) probable.push_back(i);
  }
  Candidates found{.points = {}, .rows = {}, .others = {}, .others_of_each = 0, .too_dense = {}};
  found.rows.assign(cloud.size(), kNoRow);
  Stage looking(progress, "points near edges", probable.size());
  for (const std::uint32_t i : others_of(cloud, probable, looking)) found.rows[i] = 0;
  for (const std::uint32_t i : probable) found.rows[i] = 0;
  for (std::uint32_t i = 0; i < cloud.size(); ++i) {
    if (found.rows[i] == kNoRow) continue;
    found.rows[i] = static_cast<std::uint32_t>(found.points.size());
    found.points.push_back(i);
  }
  Stage stage(progress, "exact planes", found.points.size());
  found.others = others_of(cloud, found.points, stage);
  found.others_of_each = cloud.available(kNearby);
  found.too_dense = too_dense(cloud, found, spacing);
  return found;
}

FittedPlane fitted_to(const OrderedPoints& cloud, std::span<const std::uint32_t> members) {
  PlaneSums sums{.origin = cloud.position(members.front())};
  for (const std::uint32_t i : members) sums.add(cloud.position(i));
  return fit_plane(sums);
}

/// The plane fitted to these members or, where its residual is too large, that of those that are
/// surely on it: beside a fillet others are on its beginning. None if too many are.
std::optional<FittedPlane> sure_plane(const OrderedPoints& cloud,
                                      std::span<const std::uint32_t> members, FittedPlane plane,
                                      double reach) {
  if (plane.residual <= kMostResidual * reach) return plane;
  for (const double share : kCores) {
    std::vector<std::uint32_t> core;
    for (const std::uint32_t i : members) {
      const double height = plane.normal.dot(cloud.position(i) - plane.point);
      if (std::abs(height) < share * reach) core.push_back(i);
    }
    const auto least = kLeastInCore * static_cast<double>(members.size());
    if (static_cast<double>(core.size()) < least || core.size() < kLeastOfCore) return std::nullopt;
    plane = fitted_to(cloud, core);
  }
  return plane;
}

/// Planes that grow from point to point.
class PatchGrowth {
 public:
  PatchGrowth(const OrderedPoints& cloud, const Candidates& candidates, double spacing)
      : cloud_(cloud),
        candidates_(candidates),
        spacing_(spacing),
        reach_(kReachOfPlane * spacing),
        taken_(candidates.too_dense),
        in_vain_(candidates.points.size(), 0),
        seen_(candidates.points.size(), 0) {}

  /// Grows a plane from this row if `least_on` points near it are on one.
  void try_at(std::uint32_t row, std::size_t least_on);
  std::vector<PlanePatch> found;

 private:
  bool is_free(std::uint32_t point) const {
    return candidates_.rows[point] != kNoRow && !taken_[candidates_.rows[point]];
  }
  bool set_first(std::uint32_t row, std::size_t least_on);
  void spread(std::uint32_t row);

  const OrderedPoints& cloud_;
  const Candidates& candidates_;
  double spacing_, reach_;
  std::vector<std::uint8_t> taken_;
  std::vector<std::uint8_t> in_vain_;  ///< the rows of large growths that were no plane
  std::vector<std::uint32_t> seen_;    ///< in which spread() a row was last seen
  std::uint32_t spreads_ = 0;
  FittedPlane plane_ = {};
  std::vector<std::uint32_t> members_;
};

/// The plane through the point and two near it that the most of the free points there are on.
bool PatchGrowth::set_first(std::uint32_t row, std::size_t least_on) {
  const Vec3& at = cloud_.position(candidates_.points[row]);
  std::vector<Vec3> offsets;
  for (const std::uint32_t other : candidates_.near(row)) {
    if (is_free(other)) offsets.push_back(cloud_.position(other) - at);
  }
  std::size_t most = least_on - 2;  // without the point itself
  const std::size_t through = std::min(offsets.size(), kMostThrough);
  bool is_set = false;
  for (std::size_t j = 0; j < through; ++j) {
    for (std::size_t k = j + 1; k < through; ++k) {
      const Vec3 cross = offsets[j].cross(offsets[k]);
      const double area = cross.norm();
      if (!(area > kLeastSineBetween * offsets[j].norm() * offsets[k].norm())) continue;
      const Vec3 normal = cross / area;
      std::size_t on = 0;
      for (const Vec3& offset : offsets) on += std::abs(normal.dot(offset)) < reach_;
      if (on <= most) continue;
      most = on;
      plane_ = {.point = at, .normal = normal, .residual = 0.0, .width = 0.0};
      is_set = true;
    }
  }
  return is_set;
}

/// Sets the members to the free points on the plane that hang together with the first one, and the
/// plane to theirs.
void PatchGrowth::spread(std::uint32_t row) {
  ++spreads_;
  members_ = {candidates_.points[row]};
  seen_[row] = spreads_;
  std::size_t next_fit = kLeastMembers;
  for (std::size_t k = 0; k < members_.size(); ++k) {
    for (const std::uint32_t other : candidates_.near(candidates_.rows[members_[k]])) {
      if (!is_free(other) || seen_[candidates_.rows[other]] == spreads_) continue;
      if (std::abs(plane_.normal.dot(cloud_.position(other) - plane_.point)) > reach_) continue;
      seen_[candidates_.rows[other]] = spreads_;
      members_.push_back(other);
    }
    if (members_.size() < next_fit) continue;
    plane_ = fitted_to(cloud_, members_);
    next_fit = 2 * members_.size();
  }
  if (members_.size() >= kLeastMembers) plane_ = fitted_to(cloud_, members_);
}

void PatchGrowth::try_at(std::uint32_t row, std::size_t least_on) {
  // Every point of a wide cylinder would grow the same strip of it again.
  if (taken_[row] || in_vain_[row] || !set_first(row, least_on)) return;
  spread(row);
  if (members_.size() < kManyMembers) spread(row);  // as the first plane was that of three points
  if (members_.size() < kLeastMembers) return;
  const auto plane = sure_plane(cloud_, members_, plane_, reach_);
  const bool is_plane = plane && plane->width >= kLeastPatchWidth * spacing_;
  if (!is_plane && members_.size() < kManyMembers) return;
  std::vector<std::uint8_t>& marks = is_plane ? taken_ : in_vain_;
  for (const std::uint32_t i : members_) marks[candidates_.rows[i]] = 1;
  if (!is_plane) return;
  found.push_back({plane->point, plane->normal, reach_, members_});
}

/// Planes that grow together, to be found by their distance from an origin.
class PlaneUnion {
 public:
  PlaneUnion(const OrderedPoints& cloud, double spacing)
      : cloud_(cloud), origin_(cloud.position(0)), spacing_(spacing) {}

  void add(PlanePatch patch);
  std::vector<PlanePatch> planes;

 private:
  /// The plane at about this distance that all points of the patch are on.
  PlanePatch* known_plane(const PlanePatch& patch, double distance);

  const OrderedPoints& cloud_;
  Vec3 origin_;
  double spacing_;
  std::multimap<double, std::size_t> by_distance_;
};

PlanePatch* PlaneUnion::known_plane(const PlanePatch& patch, double distance) {
  const auto end = by_distance_.upper_bound(distance + spacing_);
  for (auto entry = by_distance_.lower_bound(distance - spacing_); entry != end; ++entry) {
    PlanePatch& plane = planes[entry->second];
    const bool holds =
        std::abs(plane.normal.dot(patch.normal)) > kOneNormal &&
        std::all_of(patch.members.begin(), patch.members.end(),
                    [&](std::uint32_t i) { return plane.is_on(cloud_.position(i)); });
    if (holds) return &plane;
  }
  return nullptr;
}

void PlaneUnion::add(PlanePatch patch) {
  const double distance = patch.height(origin_);
  PlanePatch* plane = known_plane(patch, distance);
  if (!plane) plane = known_plane(patch, -distance);  // its normal may be turned round
  if (plane) {
    plane->members.insert(plane->members.end(), patch.members.begin(), patch.members.end());
    return;
  }
  by_distance_.emplace(distance, planes.size());
  planes.push_back(std::move(patch));
}

/// Whether the surface crosses this plane: nearly all of its points have others on both sides, and
/// many of them are on lines. Points on the edges of a grid are on such planes, one for each of its
/// layers.
bool is_crossed(const OrderedPoints& cloud, const Candidates& candidates, const PlanePatch& plane) {
  std::size_t amid = 0, on_lines = 0;
  for (const std::uint32_t i : plane.members) {
    bool above = false, below = false;
    std::size_t on = 0, off = 0;
    Mat3 products = Mat3::Zero();
    for (const std::uint32_t other : candidates.near(candidates.rows[i])) {
      const Vec3 offset = cloud.position(other) - cloud.position(i);
      if (!plane.is_on(cloud.position(other))) {
        if (off++ < kFewNearby) (plane.normal.dot(offset) > 0.0 ? above : below) = true;
      } else if (on++ < kFewNearby) {
        products += offset * offset.transpose();
      }
    }
    amid += above && below ? 1 : 0;
    const Vec3 spread = eigendecomposition(products).values;
    on_lines += spread[1] < kNarrowest * spread[2] ? 1 : 0;
  }
  const auto all = static_cast<double>(plane.members.size());
  return static_cast<double>(amid) >= kLeastAmid * all &&
         static_cast<double>(on_lines) >= kLeastOnLines * all;
}

/// One plane for all patches of it: those of a plate with a slot across it are two.
std::vector<PlanePatch> united(const OrderedPoints& cloud, const Candidates& candidates,
                               std::vector<PlanePatch> patches, double spacing) {
  std::stable_sort(patches.begin(), patches.end(), [](const PlanePatch& a, const PlanePatch& b) {
    return a.members.size() > b.members.size();
  });
  PlaneUnion whole(cloud, spacing);
  for (PlanePatch& patch : patches) whole.add(std::move(patch));
  for (PlanePatch& plane : whole.planes) {
    std::sort(plane.members.begin(), plane.members.end());
    const FittedPlane of_all = fitted_to(cloud, plane.members);
    const FittedPlane fitted =
        sure_plane(cloud, plane.members, of_all, plane.reach).value_or(of_all);
    plane.point = fitted.point;
    plane.normal = fitted.normal;
  }
  std::erase_if(whole.planes,
                [&](const PlanePatch& plane) { return is_crossed(cloud, candidates, plane); });
  return std::move(whole.planes);
}

}  // namespace

std::vector<PlanePatch> find_exact_planes(const OrderedPoints& cloud, double spacing,
                                          const Progress* progress) {
  if (cloud.size() <= kLeastMembers) return {};
  const Candidates candidates = find_candidates(cloud, spacing, progress);
  PatchGrowth growth(cloud, candidates, spacing);
  for (const std::size_t least_on : kOnFirst) {
    for (std::uint32_t row = 0; row < candidates.points.size(); ++row) {
      if (row % kSeedsBetweenLooks == 0) throw_if_cancelled(progress);
      growth.try_at(row, least_on);
    }
  }
  return united(cloud, candidates, std::move(growth.found), spacing);
}

}  // namespace pcednet::lines
