#pragma once

#include <span>
#include <vector>

#include "pcednet/core/vec3.h"

namespace pcednet::shapes {

/// The spacing of the points around each position: that of the regular grid whose ten nearest
/// neighbours are as far away in the mean.
std::vector<double> local_spacings(std::span<const Vec3> positions);

}  // namespace pcednet::shapes
