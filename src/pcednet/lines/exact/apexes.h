#pragma once

#include <vector>

#include "pcednet/lines/creases/crease.h"
#include "pcednet/lines/points/ordered_points.h"

namespace pcednet::lines {

/// Erases the creases on cones of exact points: at its apex, a cone looks like planes that meet
/// along its lines.
void erase_on_cones(std::vector<Crease>& creases, const OrderedPoints& cloud, double spacing);

}  // namespace pcednet::lines
