#include "workbench/shapes/varied_set.h"

#include <fmt/format.h>

#include <algorithm>

#include "pcednet/core/random.h"
#include "workbench/shapes/default_set.h"
#include "workbench/shapes/solids/part_pieces.h"
#include "workbench/shapes/surfaces/default_shapes.h"
#include "workbench/shapes/surfaces/roofs.h"

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

constexpr double kFewest = 600, kFew = 2000, kMost = 5000;
constexpr std::uint64_t kFirstSparsePart = 1000;  // after those of other sets

/// Three in five are even, one in five vertices of a mesh; one in six has noise. Half of them have
/// at most kFew points, else most points would be those of large clouds.
CadRecipe sparse_part(int family, int number, std::uint64_t seed) {
  Random random(seed, 139000 + static_cast<std::uint64_t>(100 * number + family));
  CadRecipe recipe = drawn_part("sparse", family, number, kFirstSparsePart, random);
  recipe.mesh = number % 5 == 4;
  recipe.even = !recipe.mesh && number % 5 != 0;
  recipe.one_point_wide = !recipe.mesh;
  recipe.estimated = !recipe.mesh || random.index(2) == 1;
  recipe.style = random_mesh_style(random, kFewest, number % 2 == 0 ? kFew : kMost);
  if (number % 7 == 2 && !recipe.mesh) recipe.scatter = random.uniform(0.0, 0.3);
  return recipe;
}

Recipe sparse_blocks(std::size_t number, std::uint64_t seed) {
  Random random(seed, 149000 + number);
  const std::size_t thinned = std::size_t{1} << (number % 5);
  return {.name = fmt::format("sparse_blocks_{}", number),
          .shape = random_blocks(random),
          .points = thinned * points_between(random, kFewest, kMost),
          .noise = number % 4 == 3 ? random.uniform(0.0, 0.5) : 0.0,
          .displacement = number % 4 == 1 ? random.uniform(2.0, 8.0) : 0.0,
          .normals = number % 2 == 0 ? NormalSource::kEstimated : NormalSource::kPlane10,
          .inward = random.index(2) == 1,
          .thinned = thinned};
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

std::vector<CadRecipe> sparse_part_recipes(std::uint64_t seed) {
  constexpr int kParts = 80;
  constexpr std::size_t kWorn = 48;
  std::vector<CadRecipe> recipes = parts_of_each_family(
      kParts, [seed](int family, int number) { return sparse_part(family, number, seed); });
  std::vector<CadRecipe> worn = worn_recipes(seed + 2000);
  worn.resize(std::min(worn.size(), kWorn));
  for (CadRecipe& recipe : worn) {
    Random random(seed, 159000 + recipes.size());
    recipe.name = "sparse_" + recipe.name;
    recipe.part += kFirstSparsePart - 100;
    recipe.style.points = points_between(random, kFewest, kMost);
    recipes.push_back(std::move(recipe));
  }
  return recipes;
}

std::vector<Recipe> sparse_shape_recipes(std::uint64_t seed) {
  constexpr std::size_t kBlocks = 100;
  std::vector<Recipe> recipes = default_recipes(seed + 2000);
  std::erase_if(recipes, [](const Recipe& recipe) { return recipe.points > kMost; });
  for (Recipe& recipe : recipes) recipe.name = "sparse_" + recipe.name;
  for (std::size_t number = 0; number < kBlocks; ++number) {
    recipes.push_back(sparse_blocks(number, seed));
  }
  return recipes;
}

std::vector<LineRecipe> sparse_roof_recipes(std::uint64_t seed) {
  constexpr int kRoofsPerKind = 8;
  std::vector<LineRecipe> recipes;
  for (int number = 0; number < kRoofsPerKind; ++number) {
    for (int kind = 0; kind < kRoofKinds; ++kind) {
      Random random(seed, 169000 + static_cast<std::uint64_t>(100 * number + kind));
      recipes.push_back(
          {.name = fmt::format("sparse_roof_{}_{}", roof_kind_name(kind), number),
           .kind = number % 2 == 0 ? LineRecipe::Kind::kRoof : LineRecipe::Kind::kFlownRoof,
           .family = kind,
           .part = kFirstSparsePart + static_cast<std::uint64_t>(number),
           .points = points_between(random, kFewest, kMost)});
    }
  }
  return recipes;
}

}  // namespace pcednet::shapes
