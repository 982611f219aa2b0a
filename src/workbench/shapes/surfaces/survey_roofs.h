#pragma once

#include "pcednet/core/random.h"
#include "workbench/shapes/surfaces/polyhedra.h"
#include "workbench/shapes/surfaces/roofs.h"

namespace pcednet::shapes {

/// The kinds of random_survey_roof(): those of random_roof(), half_hip, crossing (a plus of gables)
/// and dormers (two of them).
inline constexpr int kSurveyRoofKinds = kRoofKinds + 3;
const char* survey_roof_kind_name(int kind);

/// Half of them turned about z by any angle.
Polyhedron random_survey_roof(int kind, Random& random);

/// The points of a roof as an airborne survey has them: in straight rows (along y), farther apart
/// than the points of a row, the first of half the roofs just inside it; each has the mean height
/// in the footprint of its beam, which is below a ridge and above eaves; vertical noise with heavy
/// tails, slopes that are a centimetre or two off their plane, all by up to 5 centimetres too high
/// or low, on some roofs chimneys and points of the walls.
std::vector<Vec3> survey_points(const Polyhedron& roof, std::size_t points, Random& random);

}  // namespace pcednet::shapes
