#include "pcednet/lines/exact/cylinder_folds.h"

#include <Eigen/Geometry>
#include <algorithm>
#include <array>
#include <cmath>
#include <compare>
#include <optional>
#include <utility>

#include "pcednet/core/parallel.h"
#include "pcednet/core/sort_unique.h"
#include "pcednet/lines/exact/fold_search.h"
#include "pcednet/lines/exact/fold_surface.h"
#include "pcednet/spatial/kd_tree.h"

namespace pcednet::lines {
namespace {

constexpr double kParallelSine = 1e-3;  ///< of a cylinder and what meets it along its axis
constexpr double kSameFold = 0.9999;    ///< cosine of folds that are the same
constexpr std::size_t kCylindersAtOnce = 8;

// In spacings.
constexpr double kBetweenCylinders = 2.5;     ///< of their points, where they may meet
constexpr double kSameEnds = 1.0;             ///< of folds that were found twice
constexpr double kLeastOfCylinderFold = 2.0;  ///< length

/// The lines along a cylinder at both places where its circle meets another surface.
using TwoLines = std::optional<std::array<PlaneLine, 2>>;

TwoLines two_lines(const Vec3& middle, const Vec3& half, const Vec3& along) {
  return std::array<PlaneLine, 2>{PlaneLine{middle + half, along}, PlaneLine{middle - half, along}};
}

/// None if the plane is not along the cylinder, or meets it at less than 20 degrees.
TwoLines lines_where_meet(const ExactCylinder& cylinder, const PlanePatch& plane) {
  const Fit& circle = cylinder.circle;
  if (std::abs(plane.normal.dot(circle.direction)) > kParallelSine) return std::nullopt;
  const double height = plane.height(circle.point);
  const double sq_sine = 1.0 - std::pow(height / circle.radius, 2);
  if (sq_sine < kLeastSineOfFold * kLeastSineOfFold) return std::nullopt;
  return two_lines(
      circle.point - height * plane.normal,
      circle.radius * std::sqrt(sq_sine) * circle.direction.cross(plane.normal).normalized(),
      circle.direction);
}

TwoLines lines_where_meet(const ExactCylinder& a, const ExactCylinder& b) {
  const Vec3& along = a.circle.direction;
  if (along.cross(b.circle.direction).norm() > kParallelSine) return std::nullopt;
  Vec3 across = b.circle.point - a.circle.point;
  across -= along.dot(across) * along;
  const double apart = across.norm(), r = a.circle.radius, s = b.circle.radius;
  const double cosine = (r * r + s * s - apart * apart) / (2.0 * r * s);
  const double sq_sine = 1.0 - cosine * cosine;
  if (sq_sine < kLeastSineOfFold * kLeastSineOfFold) return std::nullopt;
  across /= apart;
  const double middle = (apart * apart + r * r - s * s) / (2.0 * apart);
  return two_lines(a.circle.point + middle * across,
                   (r * s * std::sqrt(sq_sine) / apart) * along.cross(across), along);
}

/// A point of a cylinder near another surface.
struct Meeting {
  std::uint32_t other, point;

  auto operator<=>(const Meeting&) const = default;  // NOLINT: no pointer; clang-tidy 14 errs
};

/// One of the points beside the line.
std::optional<Vec3> place_beside(const OrderedPoints& cloud, std::span<const Meeting> meetings,
                                 const PlaneLine& line, double spacing) {
  for (const Meeting& meeting : meetings) {
    const Vec3& place = cloud.position(meeting.point);
    if ((place - line.point).cross(line.along).norm() < kStripWidth * spacing) return place;
  }
  return std::nullopt;
}

/// The planes beside each point of none: pairs of point and plane, ascending.
using PlanesOfPoints = std::vector<std::pair<std::uint32_t, std::uint32_t>>;

PlanesOfPoints planes_of_points(const std::vector<std::span<const PlaneContact>>& free_points) {
  PlanesOfPoints pairs;
  for (const auto& contacts : free_points) {
    for (const PlaneContact& contact : contacts) pairs.emplace_back(contact.point, contact.a);
  }
  std::sort(pairs.begin(), pairs.end());
  return pairs;
}

std::vector<Meeting> planes_beside(const ExactCylinder& cylinder, const PlanesOfPoints& pairs) {
  std::vector<Meeting> found;
  for (const std::uint32_t point : cylinder.members) {
    auto pair = std::lower_bound(pairs.begin(), pairs.end(), std::pair(point, 0U));
    for (; pair != pairs.end() && pair->first == point; ++pair) {
      found.push_back({pair->second, point});
    }
  }
  sort_unique(found);
  return found;
}

/// All points of cylinders, to find the cylinders beside one.
class CylinderIndex {
 public:
  CylinderIndex(const OrderedPoints& cloud, const std::vector<ExactCylinder>& cylinders) {
    for (std::uint32_t w = 0; w < cylinders.size(); ++w) {
      for (const std::uint32_t i : cylinders[w].members) {
        places_.push_back(cloud.position(i));
        cylinder_.push_back(w);
      }
    }
    tree_.emplace(places_);
  }

  /// Those with a greater number.
  std::vector<Meeting> later_cylinders_beside(const OrderedPoints& cloud,
                                              const ExactCylinder& cylinder, std::uint32_t number,
                                              double reach) const {
    std::vector<Meeting> found;
    std::vector<spatial::Neighbour> near;
    for (const std::uint32_t i : cylinder.members) {
      tree_->within_unsorted(cloud.position(i), reach, near);
      for (const auto& other : near) {
        if (cylinder_[other.index] > number) found.push_back({cylinder_[other.index], i});
      }
    }
    sort_unique(found);
    return found;
  }

 private:
  std::vector<Vec3> places_;
  std::vector<std::uint32_t> cylinder_;
  std::optional<spatial::KdTree> tree_;
};

/// Calls visit(other, its meetings) for each other surface.
template <typename Visit>
void for_each_other(const std::vector<Meeting>& meetings, const Visit& visit) {
  for (std::size_t begin = 0, end = 0; begin < meetings.size(); begin = end) {
    while (end < meetings.size() && meetings[end].other == meetings[begin].other) ++end;
    visit(meetings[begin].other, std::span(meetings).subspan(begin, end - begin));
  }
}

/// Leaves out folds that were found before, from the other end of a cylinder.
std::vector<Piece> each_once(std::vector<Piece> folds, double spacing) {
  const EndIndex index(folds, open_ends(folds));
  std::vector<std::uint8_t> is_again(folds.size(), 0);
  std::vector<spatial::Neighbour> near;
  const auto is_same = [&](const Piece& a, const Piece& b) {
    if (std::abs(a.fit.direction.dot(b.fit.direction)) < kSameFold) return false;
    const double reach = kSameEnds * spacing;
    const auto& [first, last] = b.ends;
    const bool same_way = (a.ends[0] - first).norm() < (a.ends[0] - last).norm();
    return (a.ends[0] - (same_way ? first : last)).norm() < reach &&
           (a.ends[1] - (same_way ? last : first)).norm() < reach;
  };
  for (std::size_t k = 0; k < index.ends.size(); ++k) {
    const std::size_t fold = index.ends[k].piece;
    index.tree.within_unsorted(index.places[k], kSameEnds * spacing, near);
    for (const auto& end : near) {
      const std::size_t other = index.ends[end.index].piece;
      if (other < fold && is_same(folds[fold], folds[other])) is_again[fold] = 1;
    }
  }
  std::vector<Piece> kept;
  for (std::size_t i = 0; i < folds.size(); ++i) {
    if (!is_again[i]) kept.push_back(std::move(folds[i]));
  }
  return kept;
}

}  // namespace

std::vector<Piece> find_cylinder_folds(
    const OrderedPoints& cloud, const std::vector<PlanePatch>& planes,
    const std::vector<ExactCylinder>& cylinders,
    const std::vector<std::span<const PlaneContact>>& free_points, double spacing,
    const Progress* progress) {
  if (cylinders.empty()) return {};
  const PlanesOfPoints pairs = planes_of_points(free_points);
  const CylinderIndex index(cloud, cylinders);
  std::vector<std::vector<Piece>> of_cylinders(cylinders.size());
  Stage stage(progress, "exact folds of cylinders", cylinders.size());
  parallel_blocks(cylinders.size(), kCylindersAtOnce, [&](std::size_t begin, std::size_t end) {
    for (std::size_t w = begin; w < end; ++w) {
      const ExactCylinder& cylinder = cylinders[w];
      const auto search = [&](const TwoLines& lines, std::span<const Meeting> meetings,
                              const auto& other_surface) {
        if (!lines) return;
        for (const PlaneLine& line : *lines) {
          const auto near = place_beside(cloud, meetings, line, spacing);
          if (!near) continue;
          const FoldSearch folds(cloud, surface_of(cylinder, line), other_surface(line), line,
                                 spacing);
          append(of_cylinders[w], folds.folds_from(*near));
        }
      };
      for_each_other(planes_beside(cylinder, pairs), [&](std::uint32_t p, auto meetings) {
        search(lines_where_meet(cylinder, planes[p]), meetings,
               [&](const PlaneLine&) { return surface_of(planes[p]); });
      });
      const auto number = static_cast<std::uint32_t>(w);
      for_each_other(
          index.later_cylinders_beside(cloud, cylinder, number, kBetweenCylinders * spacing),
          [&](std::uint32_t o, auto meetings) {
            search(lines_where_meet(cylinder, cylinders[o]), meetings,
                   [&](const PlaneLine& line) { return surface_of(cylinders[o], line); });
          });
      std::erase_if(of_cylinders[w], [&](const Piece& fold) {
        return length_of(fold) < kLeastOfCylinderFold * spacing;
      });
    }
    stage.advance(end - begin);
  });
  std::vector<Piece> folds;
  for (std::vector<Piece>& of_cylinder : of_cylinders) append(folds, std::move(of_cylinder));
  return each_once(std::move(folds), spacing);
}

}  // namespace pcednet::lines
