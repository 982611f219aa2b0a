#pragma once

#include "pcednet/core/random.h"
#include "workbench/shapes/solids/solid.h"

namespace pcednet::shapes {

// Random rotationally symmetric parts, about one unit large.

Solid shaft(Random& random);
Solid flange(Random& random);
Solid gear(Random& random);
Solid ring(Random& random);
Solid dome(Random& random);
Solid knob(Random& random);

}  // namespace pcednet::shapes
