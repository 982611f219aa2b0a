#pragma once

#include <optional>
#include <span>

#include "pcednet/lines/curve.h"

namespace pcednet::shapes {

/// The largest distance of a true point from its curve.
inline constexpr double kExactFit = 1e-6;

/// The segment, arc or circle that all points (two or more, in order) lie on, if there is one.
std::optional<lines::Curve> fit_exact(std::span<const Vec3> points, bool closed);

}  // namespace pcednet::shapes
