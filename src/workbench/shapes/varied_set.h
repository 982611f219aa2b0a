#pragma once

#include <cstdint>
#include <vector>

#include "workbench/shapes/cad_set.h"
#include "workbench/shapes/line_set.h"

namespace pcednet::shapes {

/// CAD parts of `pcednet generate varied`: from a thousand points to 40,000, drawn by area or
/// vertices of a mesh, clean or noisy, all with normals estimated from what there is.
std::vector<CadRecipe> varied_part_recipes(std::uint64_t seed);

/// The clouds of `pcednet generate drawn`: clean CAD parts of 6,000 to 40,000 points, drawn by
/// area.
std::vector<CadRecipe> drawn_part_recipes(std::uint64_t seed);

/// Thinned clouds of `pcednet generate varied`: of blocks and of the paper's shapes, with the
/// labels and normals that they had before.
std::vector<Recipe> thinned_recipes(std::uint64_t seed);

/// The clouds of `pcednet generate sparse`, of 600 to 5,000 points: so few that walls, steps and
/// holes are a spacing or two wide. CAD parts, drawn by area or vertices of a mesh, some of them
/// worn, most with normals estimated from what there is.
std::vector<CadRecipe> sparse_part_recipes(std::uint64_t seed);

/// Its shapes of the default set and its blocks, some of them thinned.
std::vector<Recipe> sparse_shape_recipes(std::uint64_t seed);

/// Its roofs, seen from above.
std::vector<LineRecipe> sparse_roof_recipes(std::uint64_t seed);

}  // namespace pcednet::shapes
