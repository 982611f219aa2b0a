#include "pcednet/lines/curves/support_line.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <utility>

#include "pcednet/lines/curves/turning_points.h"

namespace pcednet::lines {
namespace {

constexpr double kMostEmpty = 7.0;       ///< more points that a turned line leaves empty
constexpr double kBreakOff = 0.25;       ///< spacings from the chord at which a line may break
constexpr std::size_t kMostBreaks = 64;  ///< that a line runs over at first

// Parts that differ by noise.
constexpr double kOutermost = 2.0;   ///< of their last points, in noise,
constexpr double kByChoice = 0.02;   ///< and in spacings, of the best of many breaks
constexpr double kLongRun = 32.0;    ///< spacings: the price of a line allows for so much
constexpr double kSameWay = 0.1;     ///< sine of the turn between them,
constexpr double kTurnByEnds = 6.0;  ///< and what noise at the ends of the shorter one adds

using Points = std::span<const Eigen::Vector2d>;

double cross(const Eigen::Vector2d& a, const Eigen::Vector2d& b) {
  return a.x() * b.y() - a.y() * b.x();
}

/// To the right of the direction.
Eigen::Vector2d outward_of(const Eigen::Vector2d& along) {
  return {along.y(), -along.x()};
}

/// The line without points beyond it that leaves the least area empty: the side of the convex hull
/// in the middle of the points.
SupportLine supported(Points outline, std::size_t first, std::size_t last) {
  const Eigen::Vector2d along = (outline[last] - outline[first]).stableNormalized();
  const Eigen::Vector2d outward = outward_of(along);
  std::vector<Eigen::Vector2d> points;  // (along, outward)
  for (std::size_t i = first; i <= last; ++i) {
    const Eigen::Vector2d offset = outline[i] - outline[first];
    points.emplace_back(offset.dot(along), offset.dot(outward));
  }
  const std::vector<Eigen::Vector2d> hull = outer_hull(std::move(points));
  const double middle = 0.5 * (hull.front().x() + hull.back().x());
  std::size_t i = 1;
  while (i + 1 < hull.size() && hull[i].x() < middle) ++i;
  SupportLine line{first, last, outward, hull.front().y()};
  if (hull.size() > 1) {
    const Eigen::Vector2d side = (hull[i] - hull[i - 1]).stableNormalized();
    line.normal = (side.x() * outward - side.y() * along).stableNormalized();
  }
  line.offset = -std::numeric_limits<double>::infinity();
  for (std::size_t k = first; k <= last; ++k) {
    line.offset = std::max(line.offset, line.normal.dot(outline[k]));
  }
  return line;
}

/// Between the line and the outline, along which it is measured, so that sides count, too.
double empty_area(const SupportLine& line, Points outline) {
  double area = 0.0;
  for (std::size_t i = line.first; i < line.last; ++i) {
    const double depth = line.offset - 0.5 * line.normal.dot(outline[i] + outline[i + 1]);
    area += depth * (outline[i + 1] - outline[i]).norm();
  }
  return area;
}

/// The line along these points, with its empty area.
SupportLine measured(Points outline, std::size_t first, std::size_t last, double spacing) {
  SupportLine line = supported(outline, first, last);
  line.empty = empty_area(line, outline) / (spacing * spacing);
  return line;
}

/// Points that a line of both parts may leave empty more than they do where they differ by noise.
double by_noise(const SupportLine& a, const SupportLine& b, Points outline, double spacing,
                double noise) {
  const auto length = [&](std::size_t from, std::size_t to) {
    return (outline[to] - outline[from]).norm() / spacing;
  };
  const double shorter = std::min(length(a.first, a.last), length(b.first, b.last));
  const double turn = std::abs(cross(a.normal, b.normal));
  if (turn > kSameWay + kTurnByEnds * noise / shorter) return 0.0;
  return (kOutermost * noise + kByChoice) * std::max(0.0, length(a.first, b.last) - kLongRun);
}

/// Unites neighbours as long as one line is cheaper, apart from noise; the best pair first.
void unite_parts(std::vector<SupportLine>& lines, Points outline, double spacing, double noise) {
  struct Pair {
    SupportLine line;
    double gain;
  };
  const auto pair_at = [&](std::size_t i) -> Pair {
    const SupportLine &a = lines[i], &b = lines[i + 1];
    if (outline[a.first] == outline[b.last]) return {a, -1.0};  // all of a loop
    const SupportLine both = measured(outline, a.first, b.last, spacing);
    const double gain = kLinePrice + a.empty + b.empty - both.empty;
    return {both, gain + by_noise(a, b, outline, spacing, noise)};
  };
  std::vector<Pair> pairs;  // of each line and the next
  for (std::size_t i = 0; i + 1 < lines.size(); ++i) pairs.push_back(pair_at(i));
  while (!pairs.empty()) {
    const auto best = std::max_element(
        pairs.begin(), pairs.end(), [](const Pair& a, const Pair& b) { return a.gain < b.gain; });
    if (!(best->gain > 0.0)) return;
    const std::ptrdiff_t at = best - pairs.begin();
    const auto i = static_cast<std::size_t>(at);
    lines[i] = best->line;
    lines.erase(lines.begin() + at + 1);
    pairs.erase(best);
    if (i > 0) pairs[i - 1] = pair_at(i - 1);
    if (i < pairs.size()) pairs[i] = pair_at(i);
  }
}

}  // namespace

std::vector<Eigen::Vector2d> outer_hull(std::vector<Eigen::Vector2d> points) {
  std::sort(points.begin(), points.end(), [](const auto& a, const auto& b) {
    return std::pair(a.x(), a.y()) < std::pair(b.x(), b.y());
  });
  std::vector<Eigen::Vector2d> hull;
  for (const Eigen::Vector2d& point : points) {
    while (hull.size() > 1 &&
           cross(hull.back() - hull[hull.size() - 2], point - hull.back()) >= 0.0) {
      hull.pop_back();
    }
    hull.push_back(point);
  }
  return hull;
}

std::vector<SupportLine> straight_parts(Points outline, double spacing, double noise) {
  if (outline.size() < 2) return {};
  const std::vector<std::size_t> breaks = turning_points(outline, kBreakOff * spacing);
  struct Best {
    double cost = std::numeric_limits<double>::infinity();
    std::size_t from = 0;
    SupportLine line;
  };
  std::vector<Best> best(breaks.size());
  best[0].cost = 0.0;
  for (std::size_t to = 1; to < breaks.size(); ++to) {
    for (std::size_t from = to > kMostBreaks ? to - kMostBreaks : 0; from < to; ++from) {
      if (outline[breaks[from]] == outline[breaks[to]]) continue;  // all of a loop
      const SupportLine line = measured(outline, breaks[from], breaks[to], spacing);
      const double cost = best[from].cost + kLinePrice + line.empty;
      if (cost < best[to].cost) best[to] = {cost, from, line};
    }
  }
  std::vector<SupportLine> lines;
  for (std::size_t at = breaks.size() - 1; at > 0; at = best[at].from) {
    lines.push_back(best[at].line);
  }
  std::reverse(lines.begin(), lines.end());
  unite_parts(lines, outline, spacing, noise);
  return lines;
}

std::optional<SupportLine> turned(const SupportLine& line, const Eigen::Vector2d& normal,
                                  Points outline, double spacing) {
  SupportLine other = line;
  other.normal = normal;
  other.offset = -std::numeric_limits<double>::infinity();
  for (std::size_t i = line.first; i <= line.last; ++i) {
    other.offset = std::max(other.offset, normal.dot(outline[i]));
  }
  other.empty = empty_area(other, outline) / (spacing * spacing);
  if (other.empty > line.empty + kMostEmpty) return std::nullopt;
  return other;
}

}  // namespace pcednet::lines
