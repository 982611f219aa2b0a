#include "bindings.h"
#include "pcednet/core/version.h"

PYBIND11_MODULE(_core, module) {
  using namespace pcednet::python;
  module.attr("__version__") = pcednet::kVersion;
  add_errors(module);
  add_models(module);
  add_clouds(module);
  add_classify(module);
  add_normals(module);
  add_train(module);
  add_lines(module);
  add_shapes(module);
  add_scores(module);
}
