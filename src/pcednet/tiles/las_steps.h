#pragma once

#include <vector>

#include "pcednet/tiles/inputs.h"
#include "pcednet/tiles/plan.h"

namespace pcednet::tiles {

/// Chooses the plan's las_steps if all inputs come from LAS: those of a single input as they are,
/// otherwise on each axis those of the finest input, or the smallest power-of-ten multiple with
/// which 32 bits hold the plan's box. Notes coordinates that are rounded.
void choose_las_steps(const std::vector<IndexedInput>& inputs, Plan& plan);

}  // namespace pcednet::tiles
