#include <pybind11/stl.h>

#include <functional>

#include "bindings.h"
#include "clouds.h"
#include "job.h"
#include "pcednet/core/error.h"
#include "workbench/shapes/building.h"
#include "workbench/shapes/cad_set.h"
#include "workbench/shapes/default_set.h"
#include "workbench/shapes/line_set.h"
#include "workbench/shapes/piece_set.h"
#include "workbench/shapes/relief.h"
#include "workbench/shapes/scan_set.h"
#include "workbench/shapes/terrain.h"
#include "workbench/shapes/varied_set.h"

namespace pcednet::python {

namespace py = pybind11;

namespace {

/// A cloud that can be made.
struct Recipe {
  std::string name;
  std::function<shapes::GeneratedCloud()> make;
};

template <typename Recipes>
void add(std::vector<Recipe>& all, const Recipes& recipes, std::uint64_t seed) {
  for (const auto& recipe : recipes) {
    all.push_back({recipe.name, [recipe, seed] { return shapes::generate(recipe, seed); }});
  }
}

/// The recipes of a set of `pcednet generate`.
std::vector<Recipe> recipes_of(const std::string& set, std::uint64_t seed) {
  std::vector<Recipe> all;
  if (set == "default") {
    add(all, shapes::default_recipes(seed), seed);
  } else if (set == "cad") {
    add(all, shapes::cad_recipes(seed), seed);
  } else if (set == "worn") {
    add(all, shapes::worn_recipes(seed), seed);
    add(all, shapes::relief_recipes(seed), seed);
  } else if (set == "varied") {
    add(all, shapes::varied_part_recipes(seed), seed);
    add(all, shapes::thinned_recipes(seed), seed);
    add(all, shapes::terrain_recipes(seed), seed);
  } else if (set == "scan") {
    add(all, shapes::scan_recipes(seed), seed);
  } else if (set == "sparse") {
    add(all, shapes::sparse_part_recipes(seed), seed);
    add(all, shapes::sparse_shape_recipes(seed), seed);
    add(all, shapes::sparse_roof_recipes(seed), seed);
  } else if (set == "drawn") {
    add(all, shapes::drawn_part_recipes(seed), seed);
  } else if (set == "pieces") {
    add(all, shapes::piece_recipes(seed), seed);
  } else if (set == "lines") {
    add(all, shapes::line_recipes(), seed);
  } else if (set == "sample") {
    all.push_back({"sample", [seed] { return shapes::building_scan(seed); }});
  } else {
    throw Error(ErrorKind::kUsage, "generate \"" + set +
                                       "\": there are default, cad, worn, scan, varied, sparse, "
                                       "drawn, pieces, lines, sample");
  }
  return all;
}

py::tuple make(const Recipe& recipe) {
  shapes::GeneratedCloud made;
  run_job({py::none()}, [&](const Progress*) { made = recipe.make(); });
  return py::make_tuple(take_apart(std::move(made.cloud)), std::move(made.curves));
}

}  // namespace

void add_shapes(py::module_& module) {
  py::class_<Recipe>(module, "Recipe").def_readonly("name", &Recipe::name).def("make", make);
  module.def("recipes", recipes_of);
}

}  // namespace pcednet::python
