#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "workbench/shapes/recipe.h"

namespace pcednet::shapes {

/// How a cloud for measuring lines is made: positions only, as files without normals, with labels
/// and the true curves.
struct LineRecipe {
  std::string name = {};
  enum class Kind {
    kClean,        ///< points of a CAD part, uniform by area
    kNoisy,        ///< the same, displaced: sigma half a spacing on each axis
    kScanned,      ///< the part scanned from twelve places around it
    kRoof,         ///< a roof, with 5 mm of noise, uniform by area
    kFlownRoof,    ///< the same, its points moved to straight rows less than two spacings apart
    kSurveyedRoof  ///< a random_survey_roof() by survey_points()
  } kind = Kind::kClean;
  int family = 0;          ///< of random_part(), or the kind of the roof
  std::uint64_t part = 0;  ///< which one of the family
  std::size_t points = 32768;
};

/// The recipes of `pcednet generate lines`. No part of them is in another set.
std::vector<LineRecipe> line_recipes();

/// The recipe's cloud and curves, parts randomly rotated. A scan has those curves of which at least
/// half is near points.
GeneratedCloud generate(const LineRecipe& recipe, std::uint64_t seed);

}  // namespace pcednet::shapes
