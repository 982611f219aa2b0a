#pragma once

#include <vector>

#include "workbench/shapes/patches.h"

namespace pcednet::shapes {

/// A part bounded by a closed polygon that changes while it is turned about the z axis.
///
/// The (radius, height) outline goes linearly from `first` at angle 0 to `last` at `angle`, corner
/// by corner, so the angle at a corner changes along its curve and an edge may fade out. Both
/// outlines are simple, counter-clockwise and of one size; radii are positive; angle < 2 pi.
struct Loft {
  std::vector<Vec2> first;
  std::vector<Vec2> last;
  double angle;
};

/// The curve of each corner becomes this many chords.
inline constexpr int kLoftChords = 192;

Shape make_shape(const Loft& loft);

}  // namespace pcednet::shapes
