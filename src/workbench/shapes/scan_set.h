#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "workbench/shapes/recipe.h"
#include "workbench/shapes/solids/scanner.h"

namespace pcednet::shapes {

/// The recipe of a labelled laser scan.
struct ScanRecipe {
  std::string name = {};
  int kind = 0;             ///< of random_scene()
  std::uint64_t scene = 0;  ///< which scene of the kind
  ScannerOptions scanner = {};
  EdgeBands bands = {.sharp = 0.49, .smooth = 1.73};  ///< in spacings at each point
};

/// The recipes of `pcednet generate scan`.
std::vector<ScanRecipe> scan_recipes(std::uint64_t seed);

/// The recipe's cloud. Normals are estimated and oriented as for files without normals. Points are
/// labelled by their distance to the scene's true edges, in multiples of the local spacing; leaves
/// are non-edge; outliers and mixed points have no label.
GeneratedCloud generate(const ScanRecipe& recipe, std::uint64_t seed);

}  // namespace pcednet::shapes
