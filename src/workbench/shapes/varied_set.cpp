#include "workbench/shapes/varied_set.h"

#include <fmt/format.h>

#include "pcednet/core/random.h"
#include "workbench/shapes/cad_parts.h"
#include "workbench/shapes/default_set.h"
#include "workbench/shapes/default_shapes.h"
#include "workbench/shapes/part_pieces.h"

namespace pcednet::shapes {
namespace {

constexpr std::uint64_t kFirstVariedPart = 20;  // after those of other sets
constexpr int kPartsPerFamily = 10, kSparseParts = 6;

CadRecipe varied_part(int family, int number, std::uint64_t seed) {
  Random random(seed, 39000 + static_cast<std::uint64_t>(100 * number + family));
  CadRecipe recipe = drawn_part("varied", family, number, kFirstVariedPart, random);
  recipe.even = number % 2 == 1 && number < kPartsPerFamily - 1;
  if (number < kSparseParts) {
    recipe.style.points = points_between(random, 700, 2000);
    recipe.scatter = number % 3 == 2 ? random.uniform(0.0, 0.3) : 0.0;
  } else if (number == kSparseParts) {
    recipe.style.points = points_between(random, 8000, 40000);
  } else if (number < kPartsPerFamily - 1) {
    recipe.style.points = points_between(random, 4000, 20000);
    recipe.scatter = random.uniform(0.1, 0.7);
  } else {
    recipe.mesh = true;
    recipe.style = random_mesh_style(random, 2000, 18000);
    recipe.noise = random.uniform(0.001, 0.006);
  }
  return recipe;
}

}  // namespace

std::vector<CadRecipe> varied_part_recipes(std::uint64_t seed) {
  return parts_of_each_family(kPartsPerFamily, [seed](int family, int number) {
    return varied_part(family, number, seed);
  });
}

std::vector<CadRecipe> drawn_part_recipes(std::uint64_t seed) {
  constexpr int kParts = 12;
  constexpr std::uint64_t kFirstDrawn = 300;
  return parts_of_each_family(kParts, [seed](int family, int number) {
    Random random(seed, 179000 + static_cast<std::uint64_t>(100 * number + family));
    CadRecipe recipe = drawn_part("drawn", family, number, kFirstDrawn, random);
    recipe.style.points = points_between(random, 6000, 40000);
    return recipe;
  });
}

std::vector<Recipe> thinned_recipes(std::uint64_t seed) {
  constexpr std::size_t kBlocks = 144;
  std::vector<Recipe> recipes;
  for (std::size_t i = 0; i < kBlocks; ++i) {
    Random random(seed, 49000 + i);
    recipes.push_back({.name = fmt::format("thinned_blocks_{}", i),
                       .shape = random_blocks(random),
                       .points = points_between(random, 5000, 30000),
                       .displacement = i / 3 % 3 == 1 ? random.uniform(2.0, 8.0) : 0.0,
                       .inward = i % 2 == 1,
                       .thinned = std::size_t{4} << (i % 3)});
  }
  for (Recipe& recipe : default_recipes(seed, {.extras = false})) {
    if (recipe.points < 7000) continue;
    recipe.name = "thinned_" + recipe.name;
    recipe.thinned = 16;
    recipes.push_back(std::move(recipe));
  }
  return recipes;
}

}  // namespace pcednet::shapes
