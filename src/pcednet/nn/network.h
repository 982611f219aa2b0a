#pragma once

#include <cstdint>

#include "pcednet/nn/model.h"

namespace pcednet::nn {

/// Weights uniform in +-sqrt(6 / (fan in + fan out)) (Glorot and Bengio 2010), biases zero.
Network make_network(const Architecture& architecture, std::uint64_t seed);

}  // namespace pcednet::nn
