#pragma once

#include <optional>
#include <vector>

#include "pcednet/core/random.h"
#include "pcednet/lines/curves/curve.h"
#include "workbench/shapes/surfaces/polyhedra.h"

namespace pcednet::shapes {

/// The kinds of random_roof(): pyramid, gable, hip, mansard, cross (an L of two gables), flat, tent
/// (five to eight slopes), zigzag (slopes up and down), gambrel, double_hip, angled, tee,
/// dormer, levels (a step between two parts).
inline constexpr int kRoofKinds = 14;
const char* roof_kind_name(int kind);

/// A roof as an airborne scanner sees it, 2 to 10 metres large: no walls, no floor.
Polyhedron random_roof(int kind, Random& random);

/// The height of the highest face above or below the place; none beside the roof.
std::optional<double> highest_at(const Polyhedron& roof, const Vec3& place);

/// Whether no face is above the place.
bool is_seen(const Polyhedron& roof, const Vec3& place);

/// The creases of an open surface as sharp edges, its outline as boundary, as seen from above: the
/// foot of a step is no line.
std::vector<lines::Curve> lines_of(const Polyhedron& surface);

}  // namespace pcednet::shapes
