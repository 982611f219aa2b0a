#pragma once

#include <cstdint>
#include <functional>
#include <span>
#include <string>
#include <vector>

#include "workbench/shapes/default_set.h"
#include "workbench/shapes/recipe.h"

namespace pcednet::shapes {

/// A cloud that can be made, of any kind of recipe.
struct CloudRecipe {
  std::string name;
  std::string details;  ///< what sets it apart within its set, in words; may be empty
  std::function<GeneratedCloud()> make;
};

/// A set of clouds, as `pcednet generate NAME` writes it.
struct CloudSet {
  std::string name;
  std::string description;
  std::function<std::vector<CloudRecipe>(std::uint64_t seed)> recipes;
};

/// All sets.
std::span<const CloudSet> cloud_sets();

/// The set `default` with these options.
std::vector<CloudRecipe> default_set(std::uint64_t seed, const DefaultSetOptions& options);

}  // namespace pcednet::shapes
