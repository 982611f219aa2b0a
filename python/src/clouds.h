#pragma once

#include <pybind11/pybind11.h>

#include <memory>
#include <string>
#include <vector>

#include "pcednet/cloud/class_table.h"
#include "pcednet/cloud/point_cloud.h"

namespace pcednet::python {

/// The data of a file's cloud besides its arrays: stored normals, other elements, records of LAS,
/// the number type of its coordinates.
struct Kept {
  std::shared_ptr<const PointCloud> cloud;
};

/// The classes that lines_of() gave.
ClassTable table_of_lines(const std::vector<std::string>& lines);

/// The arrays of `cloud`, none of them copied, and the rest as Kept.
pybind11::dict take_apart(PointCloud&& cloud);

}  // namespace pcednet::python
