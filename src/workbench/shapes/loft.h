#pragma once

#include <vector>

#include "workbench/shapes/patches.h"

namespace pcednet::shapes {

/// A part bounded by a closed polygon that changes while it revolves about the z axis.
///
/// Each corner of the (radius, height) outline moves linearly from `first` at angle 0 to `last` at
/// `angle`, so the angle at a corner changes along its curve and an edge may fade out. Both
/// outlines are simple, counter-clockwise and of the same size; radii are positive; angle < 2 pi.
struct Loft {
  std::vector<Vec2> first;
  std::vector<Vec2> last;
  double angle;
};

/// The number of chords that approximate the curve of a corner.
inline constexpr int kLoftChords = 192;

Shape make_shape(const Loft& loft);

}  // namespace pcednet::shapes
