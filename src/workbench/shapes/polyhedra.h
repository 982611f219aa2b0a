#pragma once

#include <vector>

#include "workbench/shapes/shape.h"

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

}  // namespace pcednet::shapes
