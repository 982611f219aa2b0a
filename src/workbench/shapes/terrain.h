#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "workbench/shapes/recipe.h"

namespace pcednet::shapes {

/// How a labelled cloud of rough ground with plants and houses is made.
struct TerrainRecipe {
  enum class View { kTripod, kAirborne, kDrone };
  std::string name = {};
  View view = View::kTripod;
  std::size_t points = 30000;
  double leaves = 0.3;  ///< the share of points on plants
  int houses = 3;
  bool given_normals = false;  ///< the true ones, disturbed; else estimated
};

/// The terrains of `pcednet generate varied`.
std::vector<TerrainRecipe> terrain_recipes(std::uint64_t seed);

/// The recipe's cloud. Only houses have edges: the creases of roofs and, from a tripod, the edges
/// of walls, in bands of the local spacing. Ground that is rough at every length, leaves, grass and
/// trunks are non-edge.
GeneratedCloud generate(const TerrainRecipe& recipe, std::uint64_t seed);

}  // namespace pcednet::shapes
