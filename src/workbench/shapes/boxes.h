#pragma once

#include <span>

#include "workbench/shapes/shape.h"

namespace pcednet::shapes {

/// An axis-aligned box that is filled, or cut out of what the boxes before it fill.
struct Box {
  Vec3 low;
  Vec3 high;
  bool filled = true;
};

/// The surface of the space that `boxes`, applied one after another, leave filled. Its edges are
/// all its creases, convex and concave.
Shape make_shape(std::span<const Box> boxes);

}  // namespace pcednet::shapes
