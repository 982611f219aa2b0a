#pragma once

#include <optional>

#include "pcednet/lines/fit.h"

namespace pcednet::lines {

/// Where a line and a circle, or two circles, touch near `place`: the middle of their nearest
/// points on the common normal. Nothing if they are farther apart than `within` there (a length),
/// if their directions differ, or if the normal is not known, as that of two lines.
///
/// Least squares of distances would be of no use: curves that touch are near each other over a
/// length that grows with the square root of their distance.
std::optional<Vec3> touching_place(const Fit& a, const Fit& b, const Vec3& place, double within);

}  // namespace pcednet::lines
