#pragma once

#include <cstdint>
#include <vector>

#include "workbench/shapes/cad_set.h"
#include "workbench/shapes/line_set.h"

namespace pcednet::shapes {

/// The clouds of `pcednet generate sparse`, of 600 to 5,000 points: so few that walls, steps and
/// holes are a spacing or two wide. CAD parts, drawn by area or vertices of a mesh, some of them
/// worn, most with normals estimated from what there is.
std::vector<CadRecipe> sparse_part_recipes(std::uint64_t seed);

/// Its shapes of the default set and its blocks, some of them thinned.
std::vector<Recipe> sparse_shape_recipes(std::uint64_t seed);

/// Its roofs, seen from above.
std::vector<LineRecipe> sparse_roof_recipes(std::uint64_t seed);

}  // namespace pcednet::shapes
