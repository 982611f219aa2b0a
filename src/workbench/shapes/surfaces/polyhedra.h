#pragma once

#include <span>
#include <vector>

#include "workbench/shapes/surfaces/patches.h"
#include "workbench/shapes/surfaces/shape.h"

namespace pcednet::shapes {

/// A polyhedron: corners, and faces as counter-clockwise loops of corner indices seen from outside.
/// Two faces that share a pair of corners form an edge with the strength of their angle; a pair of
/// only one face is a border, no edge.
struct Polyhedron {
  std::vector<Vec3> corners;
  std::vector<std::vector<int>> faces;  ///< convex
};
Shape make_shape(const Polyhedron& solid);

/// The regular solids about the origin, corners at distance 1 from it.
Polyhedron cube();
Polyhedron icosahedron();
Polyhedron dodecahedron();

/// An axis-aligned box that is filled, or cut out of what the boxes before it fill.
struct Box {
  Vec3 low;
  Vec3 high;
  bool filled = true;
};

/// The surface of the space that `boxes`, applied one after another, leave filled. Its edges are
/// all its creases, convex and concave.
Shape make_shape(std::span<const Box> boxes);

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
