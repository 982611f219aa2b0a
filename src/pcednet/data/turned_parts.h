#pragma once

#include "pcednet/core/random.h"
#include "pcednet/data/solid.h"

namespace pcednet::data {

// Random parts that were turned or have a centre, about one unit large.

Solid shaft(Random& random);
Solid flange(Random& random);
Solid gear(Random& random);
Solid ring(Random& random);
Solid dome(Random& random);
Solid knob(Random& random);

}  // namespace pcednet::data
