#include "pcednet/lines/fold_search.h"

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>

#include "pcednet/lines/observe.h"

namespace pcednet::lines {
namespace {

constexpr double kLeastProbability = 0.1;  ///< mean of the points at a fold
constexpr double kKnownShare = 0.2;        ///< of an interval that is a fold already

// In spacings.
constexpr double kLeastFoldLength = 0.8;
constexpr double kMostBetween = 5.0;  ///< longer folds are found without their vertices
constexpr double kAtFold = 0.7;

}  // namespace

bool FoldSearch::set_line(const Vec3& near) {
  const auto line =
      line_of_planes(a_.normal, -a_.height(near), b_.normal, -b_.height(near), kLeastSineOfFold);
  if (line) line_ = {near + line->point, line->along};
  return line.has_value();
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

/// Ascending.
std::vector<std::uint32_t> FoldSearch::points_beside(const Interval& region) const {
  std::vector<spatial::Neighbour> near;
  std::vector<std::uint32_t> beside;
  for (double at = region.from; at < region.to; at += 1.0) {
    cloud_.within(place(at), (kStripWidth + 0.5) * spacing_, near);
    for (const auto& point : near) beside.push_back(point.index);
  }
  std::sort(beside.begin(), beside.end());
  beside.erase(std::unique(beside.begin(), beside.end()), beside.end());
  return beside;
}

/// Of an edge, at those of the points that are beside the interval.
double FoldSearch::mean_probability(const Interval& interval,
                                    std::span<const std::uint32_t> points) const {
  double sum = 0.0, count = 0.0;
  for (const std::uint32_t i : points) {
    const Vec3& position = cloud_.position(i);
    const double at = along(position);
    if (at < interval.from || at > interval.to) continue;
    if ((position - place(at)).norm() > kAtFold * spacing_) continue;
    sum += static_cast<double>(cloud_.probability(i));
    count += 1.0;
  }
  return count > 0.0 ? sum / count : 0.0;
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

/// Those of each pair of sides of the line.
void FoldSearch::add_folds(const Interval& region, std::vector<Piece>& found) const {
  const std::vector<std::uint32_t> beside = points_beside(region);
  const Vec3 out_a = a_.normal.cross(line_.along), out_b = b_.normal.cross(line_.along);
  for (const Vec3& side_a : {out_a, Vec3(-out_a)}) {
    const Strip a = strip_of(cloud_, beside, a_, line_, side_a, spacing_);
    for (const Vec3& side_b : {out_b, Vec3(-out_b)}) {
      const Strip b = strip_of(cloud_, beside, b_, line_, side_b, spacing_);
      for (const Interval& interval : shared_intervals(a, b)) {
        if (interval.length() < kLeastFoldLength || !end_at_line(a, b, interval)) continue;
        if (mean_probability(interval, beside) < kLeastProbability) continue;
        found.push_back(piece_along(interval, side_a, side_b));
      }
    }
  }
}

std::vector<Piece> FoldSearch::folds(std::span<const PlaneContact> contacts) {
  std::vector<Piece> found;
  if (!set_line(cloud_.position(contacts.front().point))) return found;
  for (const Interval& region : regions(contacts)) add_folds(region, found);
  return found;
}

/// The fold along all of the interval, between two vertices, if both planes have points there on
/// one side of the line and none on the other.
std::optional<Piece> FoldSearch::fold_between(const Interval& interval) const {
  const std::vector<std::uint32_t> beside = points_beside(interval);
  if (mean_probability(interval, beside) < kLeastProbability) return std::nullopt;
  const Vec3 out_a = a_.normal.cross(line_.along), out_b = b_.normal.cross(line_.along);
  std::optional<Piece> found;
  for (const Vec3& side_a : {out_a, Vec3(-out_a)}) {
    const Strip a = strip_of(cloud_, beside, a_, line_, side_a, spacing_);
    if (!has_points_on_one_side(a, interval)) continue;
    for (const Vec3& side_b : {out_b, Vec3(-out_b)}) {
      const Strip b = strip_of(cloud_, beside, b_, line_, side_b, spacing_);
      if (!has_points_on_one_side(b, interval)) continue;
      if (found) return std::nullopt;
      found = piece_along(interval, side_a, side_b);
    }
  }
  return found;
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
    if (interval.length() < kLeastFoldLength || interval.length() > kMostBetween) continue;
    const bool is_known = std::any_of(known.begin(), known.end(), [&](const Piece& piece) {
      const Interval other = interval_of(piece);
      const double shared = std::min(interval.to, other.to) - std::max(interval.from, other.from);
      return shared > kKnownShare * interval.length();
    });
    if (is_known) continue;
    if (auto fold = fold_between(interval)) found.push_back(std::move(*fold));
  }
  return found;
}

}  // namespace pcednet::lines
