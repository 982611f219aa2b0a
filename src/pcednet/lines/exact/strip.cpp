#include "pcednet/lines/exact/strip.h"

#include <algorithm>
#include <cmath>

namespace pcednet::lines {
namespace {

// In spacings.
constexpr double kNarrow = 1.0, kClose = 0.35;  ///< from the line
constexpr double kOnLine = 0.05;
constexpr double kLeastShared = 0.5;
constexpr double kShortestGap = 2.5;
constexpr double kPointsInGap = 6.0;  ///< more are not missing by chance
constexpr double kGapMargin = 0.3;

// Shares of points.
constexpr double kWrong = 0.15;      ///< to one on the right side
constexpr double kDense = 0.2;       ///< to a spacing of the line
constexpr double kCloseOnes = 0.15;  ///< to one on the right side

/// The intervals without gaps that are not chance: the sparser the points, the longer they may be.
std::vector<Interval> likely_intervals(const std::vector<double>& places) {
  double length = 0.0;
  for (const Interval& interval : intervals_of(places, kShortestGap)) length += interval.length();
  const double apart = length / std::max(1.0, static_cast<double>(places.size()));
  return intervals_of(places, std::clamp(kPointsInGap * apart, kShortestGap, kLongestStripGap));
}

std::vector<Interval> common_to(const std::vector<Interval>& a, const std::vector<Interval>& b) {
  std::vector<Interval> common;
  for (std::size_t i = 0, j = 0; i < a.size() && j < b.size();) {
    const Interval both{std::max(a[i].from, b[j].from), std::min(a[i].to, b[j].to)};
    if (both.length() >= kLeastShared) common.push_back(both);
    a[i].to < b[j].to ? ++i : ++j;
  }
  return common;
}

bool any_holds(const std::vector<Interval>& intervals, const Interval& part) {
  return std::any_of(intervals.begin(), intervals.end(), [&](const Interval& interval) {
    return interval.from <= part.from && interval.to >= part.to;
  });
}

bool ends_at_line(const Strip& strip, const Interval& interval) {
  const double right = count_in(strip.right, interval);
  return right >= std::max(2.0, kDense * interval.length()) &&
         count_in(strip.off, interval) >= 1.0 &&
         count_in(strip.close, interval) >= kCloseOnes * right - 1.0 &&
         count_in(strip.wrong, interval) <= kWrong * right;
}

}  // namespace

double count_in(const std::vector<double>& places, const Interval& interval) {
  return static_cast<double>(std::upper_bound(places.begin(), places.end(), interval.to) -
                             std::lower_bound(places.begin(), places.end(), interval.from));
}

Strip strip_of(std::span<const PlaceBeside> places) {
  Strip strip;
  for (const auto& [along, away] : places) {
    if (away < -kNarrow || away > kStripWidth) continue;
    if (away < -kOnLine) {
      strip.wrong.push_back(along);
      continue;
    }
    strip.all.push_back(along);
    if (away > kOnLine) strip.beside.push_back(along);
    if (away < kNarrow) strip.right.push_back(along);
    if (away < kNarrow && away > kOnLine) strip.off.push_back(along);
    if (away < kClose) strip.close.push_back(along);
  }
  for (auto* row :
       {&strip.all, &strip.right, &strip.off, &strip.beside, &strip.close, &strip.wrong}) {
    std::sort(row->begin(), row->end());
  }
  return strip;
}

std::vector<Interval> intervals_of(const std::vector<double>& places, double gap) {
  std::vector<Interval> intervals;
  for (const double place : places) {
    if (intervals.empty() || place > intervals.back().to + gap) intervals.push_back({place, place});
    intervals.back().to = place;
  }
  return intervals;
}

std::vector<Interval> shared_intervals(const Strip& a, const Strip& b) {
  const std::vector<Interval> of_a = likely_intervals(a.all), of_b = likely_intervals(b.all);
  std::vector<Interval> shared;
  for (const Interval& part : common_to(of_a, of_b)) {
    if (shared.empty()) {
      shared.push_back(part);
      continue;
    }
    const Interval gap{shared.back().to, part.from};
    const Interval inside{gap.from + kGapMargin, gap.to - kGapMargin};
    const double wrong = count_in(a.wrong, inside) + count_in(b.wrong, inside);
    if (wrong <= 0.0 && gap.length() < kLongestStripGap &&
        (any_holds(of_a, gap) || any_holds(of_b, gap))) {
      shared.back().to = part.to;
    } else {
      shared.push_back(part);
    }
  }
  return shared;
}

bool has_points_on_one_side(const Strip& strip, const Interval& interval) {
  return count_in(strip.off, interval) >= 1.0 && count_in(strip.wrong, interval) <= 0.0;
}

bool end_at_line(const Strip& a, const Strip& b, const Interval& interval) {
  return ends_at_line(a, interval) && ends_at_line(b, interval) &&
         count_in(a.close, interval) + count_in(b.close, interval) >= 1.0;
}

}  // namespace pcednet::lines
