#include "pcednet/lines/roofs/outline_parts.h"

#include <algorithm>
#include <cmath>
#include <optional>
#include <utility>

#include "pcednet/lines/curves/fit.h"

namespace pcednet::lines {
namespace {

using Vec2 = Eigen::Vector2d;
using Vec2s = std::span<const Vec2>;

constexpr std::size_t kLeastOfArc = 4, kMostOfArcs = 200;
constexpr double kArcSpread = 2.0;     ///< of its depths, squared, in that of its lines
constexpr double kArcExcess = 0.45;    ///< points more in its empty area, for each spacing of it
constexpr double kLongBeside = 2.0;    ///< a straight part that goes on in an arc, in its lines
constexpr double kLargestTurn = 0.17;  ///< cosine of the turn between lines of an arc

constexpr double kCutTurn = 0.34;        ///< sine of the turn at a corner, at least
constexpr double kCutInDiscs = 4.0;      ///< length of what is cut off, in radii of the disc,
constexpr double kCutToBeside = 2.0;     ///< and in that of the parts beside
constexpr double kCornerAhead = 8.0;     ///< spacings from the end of a part to its corner
constexpr double kBesideLine = 0.35;     ///< spacings beyond a line that chance explains
constexpr double kMostFilled = 0.1;      ///< share of the points that a face would have there,
constexpr double kEnoughToTell = 3.0;    ///< which must be this many,
constexpr double kClearlyCut = 0.5;      ///< unless what is cut off is so short beside the others
constexpr std::size_t kMostCutting = 2;  ///< parts that cut off one corner

double turn_of(const SupportLine& a, const SupportLine& b) {
  return a.normal.x() * b.normal.y() - a.normal.y() * b.normal.x();
}

/// Where both lines meet, moved outward by so much.
Vec2 meeting_of(const SupportLine& a, const SupportLine& b, double outward) {
  const double to_a = a.offset + outward, to_b = b.offset + outward;
  return Vec2(to_a * b.normal.y() - to_b * a.normal.y(),
              to_b * a.normal.x() - to_a * b.normal.x()) /
         turn_of(a, b);
}

/// Sum of squares about the mean.
class Spread {
 public:
  void add(double value) { ++count_, sum_ += value, squares_ += value * value; }
  double total() const { return squares_ - sum_ * sum_ / std::max(count_, 1.0); }

 private:
  double count_ = 0.0, sum_ = 0.0, squares_ = 0.0;
};

double spread_of(const SupportLine& line, Vec2s outline) {
  Spread spread;
  for (std::size_t i = line.first; i <= line.last; ++i) {
    spread.add(line.offset - line.normal.dot(outline[i]));
  }
  return spread.total();
}

/// Straight parts in their order; those of a loop go on with the first.
class Row {
 public:
  Row(const std::vector<SupportLine>& lines, Vec2s outline)
      : lines_(lines),
        outline_(outline),
        loop_(!lines.empty() && outline[lines.front().first] == outline[lines.back().last]) {}

  std::size_t size() const { return lines_.size(); }
  const SupportLine& at(std::size_t i) const { return lines_[i % lines_.size()]; }
  const Vec2& begin(std::size_t i) const { return outline_[at(i).first]; }
  const Vec2& end(std::size_t i) const { return outline_[at(i).last]; }
  double length(std::size_t i) const { return (end(i) - begin(i)).norm(); }
  double spread(std::size_t i) const { return spread_of(at(i), outline_); }
  /// Whether part i is followed by part i + 1.
  bool goes_on(std::size_t i) const {
    return (loop_ || (i + 1) % size() != 0) && end(i) == begin(i + 1);
  }
  std::vector<Vec2> points(std::size_t first, std::size_t count) const {
    std::vector<Vec2> points = {begin(first)};
    for (std::size_t i = first; i < first + count; ++i) {
      const Vec2s part = outline_.subspan(at(i).first, at(i).last - at(i).first + 1);
      points.insert(points.end(), part.begin() + 1, part.end());
    }
    return points;
  }

 private:
  const std::vector<SupportLine>& lines_;
  Vec2s outline_;
  bool loop_;
};

/// An arc in place of `count` lines.
struct Rounding {
  std::size_t first, count;
  double saving;
  SupportArc arc;
};

double spread_of(const SupportArc& arc) {
  Spread spread;
  for (const Vec2& point : arc.points) spread.add((point - arc.centre).norm() - arc.radius);
  return spread.total();
}

/// The circle of least squares, moved to the outermost point.
std::optional<SupportArc> arc_through(std::vector<Vec2> points, bool hollow, double spacing) {
  std::vector<Vec3> places;
  for (const Vec2& point : points) places.emplace_back(point.x(), point.y(), 0.0);
  const Fit fit = fit_arc(places, spacing);
  if (fit.kind != CurveKind::kArc) return std::nullopt;
  SupportArc arc{std::move(points), fit.point.head<2>(), 0.0, hollow, false};
  const auto [least, most] =
      std::minmax_element(arc.points.begin(), arc.points.end(), [&](const Vec2& a, const Vec2& b) {
        return (a - arc.centre).squaredNorm() < (b - arc.centre).squaredNorm();
      });
  arc.radius = ((hollow ? *least : *most) - arc.centre).norm();
  return arc;
}

double empty_area(const SupportArc& arc) {
  double area = 0.0;
  for (std::size_t i = 0; i + 1 < arc.points.size(); ++i) {
    const Vec2 middle = 0.5 * (arc.points[i] + arc.points[i + 1]);
    const double depth = std::abs((middle - arc.centre).norm() - arc.radius);
    area += depth * (arc.points[i + 1] - arc.points[i]).norm();
  }
  return area;
}

/// Whether the next line goes on in the same sense, not round a corner.
bool turns_alike(const Row& row, std::size_t before, bool hollow) {
  const SupportLine &a = row.at(before), &b = row.at(before + 1);
  return row.goes_on(before) && (turn_of(a, b) < 0.0) == hollow &&
         a.normal.dot(b.normal) > kLargestTurn;
}

/// Whether the lines beside those of an arc are no more of them: longer, or of another turn.
bool ends_there(const Row& row, std::size_t first, std::size_t count, bool hollow) {
  if (count == row.size()) return true;
  double length = 0.0;
  for (std::size_t i = first; i < first + count; ++i) length += row.length(i);
  const double least = kLongBeside * length / static_cast<double>(count);
  const std::size_t before = first + row.size() - 1, last = first + count - 1;
  return (!turns_alike(row, before, hollow) || row.length(before) > least) &&
         (!turns_alike(row, last, hollow) || row.length(last + 1) > least);
}

/// The arc that saves most of those that begin with line `first`.
std::optional<Rounding> rounding_at(const Row& row, std::size_t first, double spacing) {
  std::optional<Rounding> best;
  const bool hollow = turn_of(row.at(first), row.at(first + 1)) < 0.0;
  double empty = 0.0, spread = 0.0;
  for (std::size_t count = 1; count <= row.size(); ++count) {
    const std::size_t last = first + count - 1;
    if (count > 1 && !turns_alike(row, last - 1, hollow)) break;
    empty += row.at(last).empty;
    spread += row.spread(last);
    if (count < kLeastOfArc || !ends_there(row, first, count, hollow)) continue;
    auto arc = arc_through(row.points(first, count), hollow, spacing);
    if (!arc || spread_of(*arc) > kArcSpread * spread) continue;
    arc->empty = empty_area(*arc) / (spacing * spacing);
    const double excess = arc->empty - empty;
    const double saving = kLinePrice * static_cast<double>(count) - kArcPrice - excess;
    if (excess > kArcExcess * arc->length() / spacing) continue;
    if (saving <= (best ? best->saving : 0.0)) continue;
    arc->closed = count == row.size() && turns_alike(row, last, hollow);
    best = Rounding{first, count, saving, *std::move(arc)};
  }
  return best;
}

/// Parts that cut off the corner of the parts before and after them.
struct Cut {
  std::size_t before, count;
  double ratio;  ///< its length in that of the parts beside it
  double ahead[2];
};

/// What it would be, by its shape.
std::optional<Cut> cut_after(const Row& row, std::size_t before, std::size_t count, double disc,
                             double spacing) {
  const std::size_t after = before + count + 1;
  if (after - before >= row.size()) return std::nullopt;
  for (std::size_t i = before; i < after; ++i) {
    if (!row.goes_on(i)) return std::nullopt;
  }
  const SupportLine &a = row.at(before), &b = row.at(after);
  const Vec2 &from = row.end(before), &to = row.begin(after);
  const double length = (to - from).norm();
  const double ratio = length / std::min(row.length(before), row.length(after));
  const double turn = turn_of(a, b);
  if (length > kCutInDiscs * disc || ratio > kCutToBeside || turn > -kCutTurn) return std::nullopt;
  const Vec2 corner = meeting_of(a, b, 0.0);
  Cut cut{before, count, ratio, {a.along().dot(corner - from), b.along().dot(to - corner)}};
  for (const double ahead : cut.ahead) {
    if (ahead < 0.0 || ahead > kCornerAhead * spacing) return std::nullopt;
  }
  return cut;
}

/// Whether there is no face between what is cut off and the corner: hardly a point.
bool is_empty(const Row& row, const Cut& cut, Vec2s points, double spacing) {
  const SupportLine &a = row.at(cut.before), &b = row.at(cut.before + cut.count + 1);
  const Vec2& from = row.end(cut.before);
  const Vec2 way = row.begin(cut.before + cut.count + 1) - from;
  const Vec2 outward = Vec2(way.y(), -way.x()).normalized();
  const double aside = kBesideLine * spacing;
  const auto found = std::count_if(points.begin(), points.end(), [&](const Vec2& point) {
    return a.normal.dot(point) > a.offset + aside && b.normal.dot(point) > b.offset + aside &&
           outward.dot(point - from) < 0.0;
  });
  const double depth = outward.dot(from - meeting_of(a, b, 0.0));
  const double tried = outward.dot(from - meeting_of(a, b, aside));
  const double area = 0.5 * way.norm() * std::max(0.0, tried) * tried / depth;
  const double expected = area / (spacing * spacing);
  return static_cast<double>(found) <= kMostFilled * expected &&
         (cut.ratio < kClearlyCut || expected > kEnoughToTell);
}

void erase_used(std::vector<SupportLine>& lines, const std::vector<bool>& used) {
  std::size_t i = 0;
  std::erase_if(lines, [&](const SupportLine&) { return used[i++]; });
}

}  // namespace

double SupportArc::length() const {
  double length = 0.0;
  for (std::size_t i = 1; i < points.size(); ++i) length += (points[i] - points[i - 1]).norm();
  return length;
}

std::vector<SupportArc> take_round_parts(std::vector<SupportLine>& lines, Vec2s outline,
                                         double spacing) {
  std::vector<SupportArc> arcs;
  if (lines.size() < kLeastOfArc || lines.size() > kMostOfArcs) return arcs;
  const Row row(lines, outline);
  std::vector<Rounding> found;
  for (std::size_t first = 0; first < row.size(); ++first) {
    if (auto rounding = rounding_at(row, first, spacing)) found.push_back(*std::move(rounding));
  }
  std::stable_sort(found.begin(), found.end(),
                   [](const Rounding& a, const Rounding& b) { return a.saving > b.saving; });
  std::vector<bool> used(lines.size());
  for (Rounding& rounding : found) {
    const auto each = [&](const auto& work) {
      for (std::size_t k = 0; k < rounding.count; ++k) work((rounding.first + k) % lines.size());
    };
    bool free = true;
    each([&](std::size_t i) { free = free && !used[i]; });
    if (!free) continue;
    each([&](std::size_t i) { used[i] = true; });
    arcs.push_back(std::move(rounding.arc));
  }
  erase_used(lines, used);
  return arcs;
}

void drop_cut_corners(std::vector<SupportLine>& lines, Vec2s outline, Vec2s points, double disc,
                      double spacing) {
  if (lines.empty()) return;
  const Row row(lines, outline);
  std::vector<Cut> cuts;
  for (std::size_t before = 0; before < row.size(); ++before) {
    for (std::size_t count = 1; count <= kMostCutting; ++count) {
      if (const auto cut = cut_after(row, before, count, disc, spacing)) cuts.push_back(*cut);
    }
  }
  std::stable_sort(cuts.begin(), cuts.end(),
                   [](const Cut& a, const Cut& b) { return a.ratio < b.ratio; });
  std::vector<bool> dropped(lines.size());
  for (const Cut& cut : cuts) {
    bool whole = true;
    for (std::size_t k = 0; k <= cut.count + 1; ++k) {
      whole = whole && !dropped[(cut.before + k) % lines.size()];
    }
    if (!whole || !is_empty(row, cut, points, spacing)) continue;
    for (std::size_t k = 1; k <= cut.count; ++k) dropped[(cut.before + k) % lines.size()] = true;
    lines[cut.before].to_corner[1] = cut.ahead[0];
    lines[(cut.before + cut.count + 1) % lines.size()].to_corner[0] = cut.ahead[1];
  }
  erase_used(lines, dropped);
}

}  // namespace pcednet::lines
