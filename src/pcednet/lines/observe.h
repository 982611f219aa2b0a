#pragma once

#include "pcednet/lines/chain.h"
#include "pcednet/lines/ordered_points.h"

namespace pcednet::lines {

/// Sets what the edge points around a node that no crease made say of it.
void observe(ChainNode& node, const OrderedPoints& cloud);

}  // namespace pcednet::lines
