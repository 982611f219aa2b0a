#pragma once

#include <array>
#include <optional>
#include <span>

namespace pcednet::lines {

/// A point in the coordinates of a face's plane, in spacings.
struct PlacedPoint {
  double x, y, height;
};

/// Parallel lines across a face, and what planes between them, which meet there, leave.
struct ParallelFolds {
  double direction = 0.0;  ///< across them, radians
  int count = 0;
  std::array<double, 2> offsets = {};  ///< ascending
  double least_sine = 0.0;             ///< of their angles
  double left = 0.0;                   ///< sum of squares

  /// 0 before the first fold, and one more beyond each.
  int strip_of(const PlacedPoint& point) const;
};

/// What explains the heights of points.
struct Explanation {
  std::optional<ParallelFolds> folds = {};  ///< if they do so better than a plane and a parabola
  bool is_curved = true;                    ///< unless folds leave less than a parabola
};

/// Compares a plane, a parabola, and one fold or two.
Explanation explain(std::span<const PlacedPoint> points);

}  // namespace pcednet::lines
