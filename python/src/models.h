#pragma once

#include <pybind11/pybind11.h>

#include "pcednet/detect/model.h"
#include "pcednet/gls/scale_space_options.h"

namespace pcednet::python {

/// The descriptor from keyword arguments named as the fields; missing ones have the library's
/// defaults. The package has checked the names.
gls::ScaleSpaceOptions descriptor_of(const pybind11::dict& settings);

}  // namespace pcednet::python
