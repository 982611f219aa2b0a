#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "workbench/shapes/recipe.h"

namespace pcednet::shapes {

/// The recipe of a labelled cloud of a carved or cast surface. Lengths are in mean spacings.
struct ReliefRecipe {
  std::string name = {};
  std::uint64_t relief = 0;  ///< which one
  std::size_t points = 10000;
  bool even = true;        ///< evenly spaced, as a remeshed scan; else sampled uniformly by area
  double wear = 1.0;       ///< see Wear::rounding
  EdgeBands bands = {};    ///< along lines
  double scatter = 0.0;    ///< noise on each axis
  bool estimated = false;  ///< normals from the positions
  bool inward = false;
};

/// The reliefs of `pcednet generate worn`.
std::vector<ReliefRecipe> relief_recipes(std::uint64_t seed);

/// The recipe's cloud, randomly rotated; sharp-edge along its lines, boundary along its open
/// borders, non-edge elsewhere.
GeneratedCloud generate(const ReliefRecipe& recipe, std::uint64_t seed);

}  // namespace pcednet::shapes
