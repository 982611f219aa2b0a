#pragma once

#include <span>

#include "pcednet/gls/engine/lane_types.h"

namespace pcednet::gls {

/// The kernels in the widest vector code that this processor runs.
const LaneKernels& lane_kernels();

/// Every kernel that this processor runs, the scalar-compatible baseline first; all agree to float
/// rounding.
std::span<const LaneKernels> all_lane_kernels();

}  // namespace pcednet::gls
