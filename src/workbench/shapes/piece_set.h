#pragma once

#include <cstdint>
#include <string>
#include <variant>
#include <vector>

#include "workbench/shapes/cad_set.h"
#include "workbench/shapes/line_set.h"
#include "workbench/shapes/recipe.h"
#include "workbench/shapes/scan_set.h"
#include "workbench/shapes/terrain.h"

namespace pcednet::shapes {

/// How a cloud of few points is made that is a whole thing, or a piece of a larger cloud. Positions
/// only, all labelled as the one or the other, in classes of their own: 0 whole, 1 piece.
struct PieceRecipe {
  std::string name = {};
  std::variant<CadRecipe, Recipe, LineRecipe, ScanRecipe, TerrainRecipe> whole = {};
  std::uint64_t whole_seed = 0;
  std::size_t points = 0;  ///< of the piece; 0: the whole
  enum class Cut { kBall, kColumn, kCube } cut = Cut::kBall;
};

/// The clouds of `pcednet generate pieces`: those of `pcednet generate sparse` of this seed and of
/// the one 30 above, and pieces of scans and terrains with as many points.
std::vector<PieceRecipe> piece_recipes(std::uint64_t seed);

/// The recipe's cloud. A piece is what is nearest to one of the points of the whole: in a ball, in
/// a cube, or in a vertical column of square section.
GeneratedCloud generate(const PieceRecipe& recipe, std::uint64_t seed);

}  // namespace pcednet::shapes
