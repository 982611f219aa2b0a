#pragma once

#include <vector>

#include "pcednet/core/random.h"
#include "pcednet/lines/curve.h"
#include "workbench/shapes/polyhedra.h"

namespace pcednet::shapes {

/// The kinds of random_roof(): pyramid, gable, hip, mansard, cross (an L of two gables), flat.
inline constexpr int kRoofKinds = 6;
const char* roof_kind_name(int kind);

/// A roof as an airborne scanner sees it, 2 to 10 metres large: no walls, no floor.
Polyhedron random_roof(int kind, Random& random);

/// The creases of an open surface as sharp edges, its outline as boundary.
std::vector<lines::Curve> lines_of(const Polyhedron& surface);

}  // namespace pcednet::shapes
