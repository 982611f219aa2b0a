#pragma once

#include <vector>

#include "pcednet/core/progress.h"
#include "pcednet/lines/creases/crease.h"

namespace pcednet::lines {

/// The creases where the surface ends: the line of its end, beside points that have no neighbours
/// on one side. Both sides of such a crease point into the surface.
std::vector<Crease> find_boundaries(const OrderedPoints& cloud, const Progress* progress);

}  // namespace pcednet::lines
