#include "workbench/shapes/default_set.h"

#include <fmt/format.h>

#include <cmath>
#include <numbers>

#include "pcednet/core/random.h"
#include "workbench/shapes/surfaces/default_shapes.h"
#include "workbench/shapes/surfaces/polyhedra.h"

namespace pcednet::shapes {
namespace {

/// The paper's set: Table "Statistics of the datasets", rows of usage T.
std::vector<Recipe> paper_recipes() {
  const Shape plate = cone_on_plate();
  const Shape fan = fan_part();
  // The bands follow from the class shares of the table.
  const EdgeBands cube_bands = {.sharp = 0.5, .smooth = 1.48};
  const EdgeBands cone_bands = {.sharp = 0.57, .smooth = 1.66};
  const EdgeBands fan_bands = {.sharp = 0.98, .smooth = 1.78};
  return {
      {.name = "cube_0", .shape = make_shape(cube()), .points = 1500, .bands = cube_bands},
      {.name = "cube_1",
       .shape = make_shape(cube()),
       .points = 1500,
       .bands = cube_bands,
       .displacement = 3.0,
       .inward = true},
      {.name = "icosahedron_0",
       .shape = make_shape(icosahedron()),
       .points = 600,
       .bands = {.sharp = 0.46, .smooth = 1.364}},
      {.name = "cone_0", .shape = plate, .points = 7700, .bands = cone_bands, .inward = true},
      {.name = "cone_1", .shape = plate, .points = 7700, .bands = cone_bands, .displacement = 5.0},
      {.name = "dodecahedron_0",
       .shape = make_shape(dodecahedron()),
       .points = 12000,
       .bands = {.sharp = 0.292, .smooth = 0.957},
       .inward = true},
      {.name = "fandisk_0", .shape = fan, .points = 106500, .bands = fan_bands},
      {.name = "fandisk_1",
       .shape = fan,
       .points = 106500,
       .bands = fan_bands,
       .displacement = 8.0,
       .inward = true},
      {.name = "fourcube_0",
       .shape = four_cubes(),
       .points = 43900,
       .bands = {.sharp = 0.84, .smooth = 1.7}},
  };
}

/// Boxes at random, in the sizes and with the faults of the evaluation clouds.
void add_blocks(std::vector<Recipe>& recipes, std::uint64_t seed) {
  struct Variant {
    std::size_t points;
    double noise = 0.0;
    double displacement = 0.0;
    double unevenness = 1.0;
    NormalSource normals = NormalSource::kPlane10;
  };
  const Variant variants[] = {
      {.points = 5000},
      {.points = 9000},
      {.points = 7000, .displacement = 4.0},
      {.points = 9000, .displacement = 6.0},
      {.points = 6000, .displacement = 8.0},
      {.points = 7000, .noise = 0.1},
      {.points = 9000, .noise = 0.25},
      {.points = 8000, .noise = 0.5, .normals = NormalSource::kEstimated},
      {.points = 8000, .unevenness = 5.0},
      {.points = 9000, .normals = NormalSource::kSurface},
      {.points = 8000, .noise = 0.2, .normals = NormalSource::kSurface},
      {.points = 8000, .normals = NormalSource::kEstimated},
  };
  for (std::size_t i = 0; i < std::size(variants); ++i) {
    Random random(seed, 1000 + i);
    const Variant& variant = variants[i];
    recipes.push_back({.name = fmt::format("x_blocks_{}", i),
                       .shape = random_blocks(random),
                       .points = variant.points,
                       .noise = variant.noise,
                       .displacement = variant.displacement,
                       .unevenness = variant.unevenness,
                       .normals = variant.normals,
                       .inward = i % 2 == 1});
  }
}

/// Other angles, edges that fade or are rounded, and surfaces without edges.
void add_other_edges(std::vector<Recipe>& recipes) {
  // The whole width of a rounding of radius r is a smooth edge: half of it is r pi/4.
  constexpr double kRadius = 0.06;
  const Shape rounded = rounded_box(kRadius);
  const double spacing = std::sqrt(surface_area(rounded) / 12000.0);
  const EdgeBands rounded_bands = {.sharp = 0.49,
                                   .smooth = kRadius / spacing * std::numbers::pi / 4.0};
  const auto estimated = NormalSource::kEstimated;
  const Recipe clean[] = {
      {.name = "x_wedges", .shape = wedges(), .points = 12000},
      {.name = "x_sheets", .shape = open_sheets(), .points = 10000, .unevenness = 4.0},
      {.name = "x_fading", .shape = fading_creases(), .points = 15000},
      {.name = "x_rounded", .shape = rounded, .points = 12000, .bands = rounded_bands},
      {.name = "x_round", .shape = round_solids(), .points = 9000},
  };
  for (const Recipe& recipe : clean) {
    for (int i = 0; i < 3; ++i) {
      Recipe variant = recipe;
      variant.name += fmt::format("_{}", i);
      if (i == 1) variant.displacement = 5.0;
      if (i == 2) variant.noise = 0.25;
      if (i == 2) variant.normals = estimated;
      variant.inward = i == 1;
      recipes.push_back(variant);
    }
  }
}

/// Walls as scanned from the street.
void add_walls(std::vector<Recipe>& recipes, std::uint64_t seed) {
  for (int i = 0; i < 4; ++i) {
    Random random(seed, 2000 + i);
    recipes.push_back({.name = fmt::format("x_wall_{}", i),
                       .shape = wall_front(random),
                       .points = 25000,
                       .noise = 0.2 * i,
                       .unevenness = 1.0 + 2.0 * i,
                       .normals = i < 2 ? NormalSource::kPlane10 : NormalSource::kEstimated,
                       .inward = i % 2 == 1});
  }
}

}  // namespace

std::vector<Recipe> default_recipes(std::uint64_t seed, const DefaultSetOptions& options) {
  std::vector<Recipe> recipes = paper_recipes();
  if (options.extras) {
    add_blocks(recipes, seed);
    add_other_edges(recipes);
    add_walls(recipes, seed);
  }
  if (options.bands) {
    for (Recipe& recipe : recipes) recipe.bands = *options.bands;
  }
  return recipes;
}

}  // namespace pcednet::shapes
