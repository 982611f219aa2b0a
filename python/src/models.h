#pragma once

#include <pybind11/pybind11.h>

#include <span>
#include <string>

#include "pcednet/core/vec3.h"
#include "pcednet/detect/model.h"
#include "pcednet/detect/points/prepare.h"
#include "pcednet/gls/scale_space_options.h"

namespace pcednet::python {

/// `options` with the keyword arguments of describe() that are given. The package has checked the
/// names.
gls::ScaleSpaceOptions descriptor_of(const pybind11::dict& settings,
                                     gls::ScaleSpaceOptions options = {});

/// gls::note_on_extent() of a cloud at these positions.
std::string note_on_extent(const gls::ScaleSpaceOptions& options, std::span<const Vec3> positions,
                           const std::string& whose = "");

/// formats::note_on_float() of a cloud that is described at scales from `s_min`; empty unless
/// detect::may_be_too_coarse().
std::string note_on_float(bool is_float32, const detect::PreparedCloud& cloud,
                          const gls::ScaleSpaceOptions& options, double s_min);

}  // namespace pcednet::python
