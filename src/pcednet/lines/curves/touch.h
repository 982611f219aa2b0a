#pragma once

#include <optional>

#include "pcednet/lines/curves/fit.h"

namespace pcednet::lines {

/// The least cosine of the directions of curves of two kinds where they touch.
inline constexpr double kTouching = 0.94;

/// The point where a line and a circle, or two circles, touch near `place`: the midpoint of their
/// nearest points on the common normal. None if they are farther apart than `within` there (a
/// length), if their directions differ, or if the normal is undetermined, as for two lines.
///
/// Least squares of distances would not work: curves that touch are near each other over a length
/// that grows with the square root of their distance.
std::optional<Vec3> touching_place(const Fit& a, const Fit& b, const Vec3& place, double within);

}  // namespace pcednet::lines
