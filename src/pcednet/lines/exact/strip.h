#pragma once

#include <span>
#include <vector>

namespace pcednet::lines {

inline constexpr double kStripWidth = 2.5;        ///< spacings
inline constexpr double kLongestStripGap = 12.0;  ///< spacings

// An exact edge: its least length and the reach of the points at it, in spacings, and their least
// mean probability of an edge.
inline constexpr double kLeastExactLength = 0.8, kAtExactEdge = 0.7, kLeastExactProbability = 0.1;

/// A part of a line or circle: places along it, in spacings.
struct Interval {
  double from, to;

  double length() const { return to - from; }
};

/// Where a point of a surface is beside a line or circle on it, in spacings.
struct PlaceBeside {
  double along, away;
};

/// The points of a surface beside a line on it, as their places along the line in ascending order.
struct Strip {
  std::vector<double> all;     ///< up to 2.5 spacings from the line, on one side or on the line
  std::vector<double> right;   ///< of those up to one spacing from it
  std::vector<double> off;     ///< of these, not on the line
  std::vector<double> beside;  ///< of all, not on the line
  std::vector<double> close;   ///< of `right`, up to .35 spacings from it or on it
  std::vector<double> wrong;   ///< up to one spacing from the line on its other side
};

/// How many of the places, which ascend, are in the interval.
double count_in(const std::vector<double>& places, const Interval& interval);

/// The strip on the side where places are away by positive lengths.
Strip strip_of(std::span<const PlaceBeside> places);

/// From place to place, with gaps up to `gap`.
std::vector<Interval> intervals_of(const std::vector<double>& places, double gap);

/// Where both surfaces have points. A gap of one does not count where the other has points all
/// along it and does not go on beyond the line.
std::vector<Interval> shared_intervals(const Strip& a, const Strip& b);

/// Whether the surface has points beside the interval, up to one spacing from it, and none on the
/// line's other side.
bool has_points_on_one_side(const Strip& strip, const Interval& interval);

/// Whether both surfaces end at the line all along the interval.
bool end_at_line(const Strip& a, const Strip& b, const Interval& interval);

}  // namespace pcednet::lines
