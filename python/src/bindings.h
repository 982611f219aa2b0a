#pragma once

#include <pybind11/pybind11.h>

namespace pcednet::python {

// The bindings, each group in the source file of its name. The package in ../pcednet checks and
// converts the arguments and documents the functions.

void add_errors(pybind11::module_& module);
void add_models(pybind11::module_& module);
void add_clouds(pybind11::module_& module);
void add_classify(pybind11::module_& module);
void add_normals(pybind11::module_& module);
void add_train(pybind11::module_& module);
void add_lines(pybind11::module_& module);
void add_shapes(pybind11::module_& module);
void add_scores(pybind11::module_& module);

}  // namespace pcednet::python
