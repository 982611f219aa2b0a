#include "workbench/shapes/sets.h"

#include <fmt/format.h>

#include "workbench/shapes/cad_set.h"
#include "workbench/shapes/line_set.h"
#include "workbench/shapes/piece_set.h"
#include "workbench/shapes/relief.h"
#include "workbench/shapes/scan_set.h"
#include "workbench/shapes/terrain.h"
#include "workbench/shapes/varied_set.h"

namespace pcednet::shapes {

namespace {

std::string details(const Recipe& recipe) {
  std::string faults;
  if (recipe.noise > 0.0) faults += fmt::format("  noise {:.2g}", recipe.noise);
  if (recipe.displacement > 0.0) faults += fmt::format("  displaced {}", recipe.displacement);
  if (recipe.unevenness != 1.0) faults += fmt::format("  uneven {}", recipe.unevenness);
  if (recipe.inward) faults += "  inward";
  return faults;
}

std::string details(const CadRecipe& recipe) {
  return fmt::format("  {}{}{}", recipe.mesh ? "vertices" : "drawn",
                     recipe.estimated ? ", normals estimated" : "",
                     recipe.noise > 0.0 ? fmt::format(", noise {:.2g}", recipe.noise) : "");
}

std::string details(const ReliefRecipe& recipe) {
  return fmt::format("  {}{}", recipe.even ? "even" : "drawn",
                     recipe.estimated ? ", normals estimated" : "");
}

std::string details(const ScanRecipe& recipe) {
  return fmt::format("  noise {:.2g}", recipe.scanner.range_noise);
}

std::string details(const TerrainRecipe& recipe) {
  return fmt::format("  {:.0f} % leaves{}", 100.0 * recipe.leaves,
                     recipe.given_normals ? ", normals given" : "");
}

std::string details(const LineRecipe&) {
  return "";
}

std::string details(const PieceRecipe& recipe) {
  return recipe.points == 0 ? "  whole" : "  piece";
}

/// The recipes of these lists, one list after another.
template <typename... Recipes>
std::vector<CloudRecipe> joined(std::uint64_t seed, const std::vector<Recipes>&... lists) {
  std::vector<CloudRecipe> all;
  const auto add = [&](const auto& list) {
    for (const auto& recipe : list) {
      all.push_back(
          {recipe.name, details(recipe), [recipe, seed] { return generate(recipe, seed); }});
    }
  };
  (add(lists), ...);
  return all;
}

/// The set of the recipes that these functions give for a seed.
template <typename... Recipes>
CloudSet set_of(const std::string& name, const std::string& description,
                std::vector<Recipes> (*... recipes)(std::uint64_t seed)) {
  return {name, description, [=](std::uint64_t seed) { return joined(seed, recipes(seed)...); }};
}

}  // namespace

std::vector<CloudRecipe> default_set(std::uint64_t seed, const DefaultSetOptions& options) {
  return joined(seed, default_recipes(seed, options));
}

std::span<const CloudSet> cloud_sets() {
  static const std::vector<CloudSet> kSets = {
      {"default",
       "Labelled clouds for training: a remake of the paper's Default training set, and more",
       [](std::uint64_t seed) { return default_set(seed, {}); }},
      set_of("cad", "Labelled clouds for training: CAD parts, as mesh vertices or surface samples",
             cad_recipes),
      set_of("worn",
             "Labelled clouds for training: worn parts and reliefs with labelled ridge lines",
             worn_recipes, relief_recipes),
      set_of("scan",
             "Labelled clouds for training: laser scans of facades, yards, rooms and monuments",
             scan_recipes),
      set_of("varied",
             "Labelled clouds for training: CAD parts from a thousand points on, clean and noisy, "
             "with estimated normals, thinned clouds, and terrains with plants and houses",
             varied_part_recipes, thinned_recipes, terrain_recipes),
      set_of("sparse",
             "Labelled clouds for training: CAD parts, blocks and roofs of 600 to 5,000 points",
             sparse_part_recipes, sparse_shape_recipes, sparse_roof_recipes),
      set_of("drawn",
             "Labelled clouds for training: CAD parts of 6,000 to 40,000 points drawn by area, "
             "clean",
             drawn_part_recipes),
      set_of("pieces",
             "Clouds of 600 to 5,000 points, labelled as whole things or as pieces of scans",
             piece_recipes),
      {"lines",
       "Clouds with true curves for measuring lines: CAD parts, clean, noisy and scanned, "
       "and roofs",
       [](std::uint64_t seed) { return joined(seed, line_recipes()); }}};
  return kSets;
}

}  // namespace pcednet::shapes
