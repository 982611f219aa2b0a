#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "workbench/shapes/recipe.h"

namespace pcednet::shapes {

/// How a labelled cloud of a carved or cast surface is made. Lengths are in mean spacings.
struct ReliefRecipe {
  std::string name = {};
  std::uint64_t relief = 0;  ///< which one
  std::size_t points = 10000;
  bool even = true;        ///< an even cover, as of a remeshed scan; else drawn by area
  double wear = 1.0;       ///< see Wear::rounding
  double band = 0.8;       ///< points this near a line are sharp-edge
  double scatter = 0.0;    ///< noise on each axis
  bool estimated = false;  ///< normals from the positions
  bool inward = false;
};

/// The reliefs among the worn things.
std::vector<ReliefRecipe> relief_recipes(std::uint64_t seed);

/// The recipe's cloud, turned at random; sharp-edge along its lines, non-edge elsewhere, at its
/// open borders too.
GeneratedCloud generate(const ReliefRecipe& recipe, std::uint64_t seed);

}  // namespace pcednet::shapes
