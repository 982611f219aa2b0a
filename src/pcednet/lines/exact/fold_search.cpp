#include "pcednet/lines/exact/fold_search.h"

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>

#include "pcednet/lines/exact/fillet.h"
#include "pcednet/lines/pieces/observe.h"

namespace pcednet::lines {
namespace {

constexpr double kKnownShare = 0.2;  ///< of an interval that is a fold already

// In spacings.
constexpr double kMostBetween = 5.0;  ///< longer folds are found without their vertices
constexpr double kStepAlong = 0.5 * kLongestStripGap;  ///< where a line is followed
constexpr double kAlongLine = 1.0;                     ///< of points that it has there
constexpr double kBeforeVertex = 0.05;                 ///< of points of the third plane of a vertex

double shared_length(const Interval& a, const Interval& b) {
  return std::min(a.to, b.to) - std::max(a.from, b.from);
}

void move_by(Piece& segment, const Vec3& offset) {
  segment.fit.point += offset;
  for (Vec3& end : segment.ends) end += offset;
  for (ChainNode& node : segment.nodes) node.at += offset;
}

}  // namespace

std::optional<PlaneLine> fold_line(const PlanePatch& a, const PlanePatch& b, const Vec3& near) {
  auto line =
      line_of_planes(a.normal, -a.height(near), b.normal, -b.height(near), kLeastSineOfFold);
  if (line) line->point += near;
  return line;
}

/// Where contacts are, with room for points that were not found on the planes.
std::vector<Interval> FoldSearch::regions(std::span<const PlaneContact> contacts) const {
  std::vector<double> places;
  for (const PlaneContact& contact : contacts) {
    const Vec3& position = cloud_.position(contact.point);
    const double at = along(position);
    if ((position - place(at)).norm() > kStripWidth * spacing_) continue;
    places.push_back(at);
  }
  std::sort(places.begin(), places.end());
  std::vector<Interval> found = intervals_of(places, 2.0 * kLongestStripGap);
  for (Interval& region : found) {
    region.from -= 0.5 * kLongestStripGap;
    region.to += 0.5 * kLongestStripGap;
  }
  return found;
}

/// As far as there are points beside the line without a gap that no strip may have.
Interval FoldSearch::reachable_from(double start) const {
  const auto end_towards = [&](double step) {
    double end = start;
    std::vector<Vec3> places(static_cast<std::size_t>(kStepAlong));
    for (int empty = 0; empty < 2; end += step) {
      for (std::size_t i = 0; i < places.size(); ++i) {
        places[i] = place(end + step * static_cast<double>(i) / kStepAlong);
      }
      empty = cloud_.near_any(places, kAlongLine * spacing_).empty() ? empty + 1 : 0;
    }
    return end;
  };
  return {end_towards(-kStepAlong), end_towards(kStepAlong)};
}

/// Ascending.
std::vector<std::uint32_t> FoldSearch::points_beside(const Interval& region) const {
  std::vector<Vec3> places;
  for (double at = region.from; at < region.to; at += 1.0) places.push_back(place(at));
  return cloud_.near_any(places, (kStripWidth + 0.5) * spacing_);
}

/// Those at the line or, as a short fold may have none there, those beside it.
double FoldSearch::mean_probability(const Interval& interval,
                                    std::span<const std::uint32_t> points) const {
  for (const double reach : {kAtExactEdge, kStripWidth}) {
    double sum = 0.0, count = 0.0;
    for (const std::uint32_t i : points) {
      const Vec3& position = cloud_.position(i);
      const double at = along(position);
      if (at < interval.from || at > interval.to) continue;
      if ((position - place(at)).norm() > reach * spacing_) continue;
      sum += static_cast<double>(cloud_.probability(i));
      count += 1.0;
    }
    if (count > 0.0) return sum / count;
  }
  return 0.0;
}

Piece FoldSearch::piece_along(const Interval& interval, const Vec3& side_a,
                              const Vec3& side_b) const {
  Piece piece{.fit = {CurveKind::kSegment, line_.point, line_.along},
              .nodes = {},
              .ends = {place(interval.from), place(interval.to)},
              .exact = true};
  const ChainNode like{.at = line_.point,
                       .along = line_.along,
                       .side_a = side_a,
                       .side_b = side_b,
                       .spacing = spacing_};
  add_observed_nodes(piece, static_cast<std::size_t>(std::ceil(interval.length())), like, cloud_);
  return piece;
}

/// Both sides of the line on one of the surfaces.
std::array<FoldSearch::Side, 2> FoldSearch::sides_of(const FoldSurface& surface,
                                                     std::span<const std::uint32_t> points) const {
  const Vec3 into = surface.normal.cross(line_.along);
  const auto side = [&](const Vec3& to) {
    std::vector<PlaceBeside> places;
    for (const std::uint32_t i : points) {
      const Vec3& position = cloud_.position(i);
      if (!surface.is_on(position)) continue;
      places.push_back({along(position), (position - line_.point).dot(to) / spacing_});
    }
    return Side{to, strip_of(places)};
  };
  return {side(into), side(-into)};
}

/// Those of each pair of sides of the line.
void FoldSearch::add_folds(const Interval& region, std::vector<Piece>& found) const {
  const std::vector<std::uint32_t> beside = points_beside(region);
  const std::array<Side, 2> of_a = sides_of(a_, beside), of_b = sides_of(b_, beside);
  for (const Side& a : of_a) {
    for (const Side& b : of_b) {
      for (const Interval& interval : shared_intervals(a.strip, b.strip)) {
        if (interval.length() < kLeastExactLength) continue;
        if (!end_at_line(a.strip, b.strip, interval)) continue;
        if (mean_probability(interval, beside) < kLeastExactProbability) continue;
        found.push_back(piece_along(interval, a.into, b.into));
      }
    }
  }
}

/// Those in each of the four corners of the planes.
void FoldSearch::add_fillets(const Interval& region, std::vector<Piece>& found) const {
  const std::vector<std::uint32_t> beside = points_beside(region);
  const Vec3 into_a = a_.normal.cross(line_.along), into_b = b_.normal.cross(line_.along);
  for (const double sign_a : {1.0, -1.0}) {
    for (const double sign_b : {1.0, -1.0}) {
      const Vec3 side_a = sign_a * into_a, side_b = sign_b * into_b;
      const Vec3 half_way = (side_a + side_b).normalized(), across = (side_a - side_b).normalized();
      std::vector<CornerPoint> points;
      for (const std::uint32_t i : beside) {
        const Vec3 offset = (cloud_.position(i) - line_.point) / spacing_;
        points.push_back({offset.dot(line_.along), {offset.dot(half_way), offset.dot(across)}});
      }
      const auto fillet = find_fillet(points, std::acos(side_a.dot(half_way)));
      if (!fillet) continue;
      for (const Interval& interval : fillet->intervals) {
        Piece piece = piece_along(interval, side_a, side_b);
        move_by(piece, fillet->depth * spacing_ * half_way);
        piece.rounded = true;
        found.push_back(std::move(piece));
      }
    }
  }
}

std::vector<Piece> FoldSearch::folds(std::span<const PlaneContact> contacts) const {
  std::vector<Piece> found;
  for (const Interval& region : regions(contacts)) add_folds(region, found);
  return found;
}

std::vector<Piece> FoldSearch::folds_from(const Vec3& near) const {
  std::vector<Piece> found;
  add_folds(reachable_from(along(near)), found);
  return found;
}

std::vector<Piece> FoldSearch::fillets(std::span<const PlaneContact> contacts) const {
  std::vector<Piece> found;
  for (const Interval& region : regions(contacts)) add_fillets(region, found);
  return found;
}

bool FoldSearch::is_rounded(const Piece& fold, std::span<const Piece> fillets) const {
  const Interval interval = interval_of(fold);
  return std::any_of(fillets.begin(), fillets.end(), [&](const Piece& fillet) {
    return shared_length(interval, interval_of(fillet)) > 0.5 * interval.length();
  });
}

/// Whether there is nothing but the two surfaces beside the interval, between its vertices.
bool FoldSearch::has_only_surfaces(const Interval& interval,
                                   std::span<const std::uint32_t> points) const {
  return std::ranges::none_of(points, [&](std::uint32_t i) {
    const Vec3& position = cloud_.position(i);
    const double at = along(position);
    return at > interval.from + kBeforeVertex && at < interval.to - kBeforeVertex &&
           (position - place(at)).norm() < kStripWidth * spacing_ && !a_.is_on(position) &&
           !b_.is_on(position);
  });
}

/// The fold along all of the interval, between two vertices, if both planes have points there on
/// one side of the line and none on the other. The nearest may be farther away than those of longer
/// folds, by chance, if nothing else is there.
std::optional<Piece> FoldSearch::fold_between(const Interval& interval) const {
  const std::vector<std::uint32_t> beside = points_beside(interval);
  if (mean_probability(interval, beside) < kLeastExactProbability) return std::nullopt;
  const std::array<Side, 2> of_a = sides_of(a_, beside), of_b = sides_of(b_, beside);
  const auto near_side = [&](const std::array<Side, 2>& sides) {
    const auto side = std::ranges::find_if(
        sides, [&](const Side& one) { return has_points_on_one_side(one.strip, interval); });
    return side == sides.end() ? nullptr : &*side;
  };
  const auto only_side = [&](const std::array<Side, 2>& sides) {
    const bool first = count_in(sides[0].strip.beside, interval) > 0.0,
               second = count_in(sides[1].strip.beside, interval) > 0.0;
    return first == second ? nullptr : &sides[first ? 0 : 1];
  };
  const Side *a = near_side(of_a), *b = near_side(of_b);
  if ((!a || !b) && !has_only_surfaces(interval, beside)) return std::nullopt;
  if (!a) a = only_side(of_a);
  if (!b) b = only_side(of_b);
  if (!a || !b) return std::nullopt;
  return piece_along(interval, a->into, b->into);
}

Interval FoldSearch::interval_of(const Piece& piece) const {
  const auto [from, to] = std::minmax({along(piece.ends[0]), along(piece.ends[1])});
  return {from, to};
}

std::vector<Piece> FoldSearch::folds_between(std::span<const Vec3> vertices,
                                             std::span<const Piece> known) const {
  std::vector<double> places;
  for (const Vec3& vertex : vertices) places.push_back(along(vertex));
  std::sort(places.begin(), places.end());
  std::vector<Piece> found;
  for (std::size_t i = 0; i + 1 < places.size(); ++i) {
    const Interval interval{places[i], places[i + 1]};
    if (interval.length() < kLeastExactLength || interval.length() > kMostBetween) continue;
    const bool is_known = std::any_of(known.begin(), known.end(), [&](const Piece& piece) {
      return shared_length(interval, interval_of(piece)) > kKnownShare * interval.length();
    });
    if (is_known) continue;
    if (auto fold = fold_between(interval)) found.push_back(std::move(*fold));
  }
  return found;
}

}  // namespace pcednet::lines
