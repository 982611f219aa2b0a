#include <pybind11/stl.h>

#include "bindings.h"
#include "clouds.h"
#include "job.h"
#include "pcednet/core/error.h"
#include "workbench/shapes/building.h"
#include "workbench/shapes/sets.h"

namespace pcednet::python {

namespace py = pybind11;

namespace {

/// The recipes of a set of `pcednet generate`, or the sample alone.
std::vector<shapes::CloudRecipe> recipes_of(const std::string& name, std::uint64_t seed) {
  std::string names;
  for (const shapes::CloudSet& set : shapes::cloud_sets()) {
    if (set.name == name) return set.recipes(seed);
    names += set.name + ", ";
  }
  if (name == "sample") return {{"sample", "", [seed] { return shapes::building_scan(seed); }}};
  throw Error(ErrorKind::kUsage, "generate \"" + name + "\": there are " + names + "sample");
}

py::tuple make(const shapes::CloudRecipe& recipe) {
  shapes::GeneratedCloud made;
  run_job({py::none()}, [&](const Progress*) { made = recipe.make(); });
  return py::make_tuple(take_apart(std::move(made.cloud)), std::move(made.curves));
}

}  // namespace

void add_shapes(py::module_& module) {
  py::class_<shapes::CloudRecipe>(module, "Recipe")
      .def_readonly("name", &shapes::CloudRecipe::name)
      .def("make", make);
  module.def("recipes", recipes_of);
}

}  // namespace pcednet::python
