#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "pcednet/core/random.h"
#include "workbench/shapes/recipe.h"
#include "workbench/shapes/surfaces/shape.h"

namespace pcednet::shapes {

/// A carved or cast surface with open borders: a bent plate with raised or sunken ornaments.
struct Relief {
  Shape shape;              ///< one patch, no edge curves
  std::vector<Vec3> lines;  ///< dense points on the ridge and valley lines of the ornaments
};

/// Discs and domes, meanders, spirals, strokes, nested rings, flutes and terraces, with steep or
/// soft flanks, on a plate about one unit large that is bent and slightly wavy. `line_points` is
/// the approximate number of points on the lines.
Relief random_relief(Random& random, std::size_t line_points = 60000);

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
