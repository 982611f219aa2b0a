#pragma once

#include <cstdint>
#include <vector>

#include "pcednet/nn/architecture.h"

namespace pcednet::nn {

/// A shape and its weights, layer by layer: the weights of a layer (row-major, shape as in
/// Layer::weight_shape), then its biases.
struct Network {
  Architecture architecture;
  std::vector<float> parameters;
};

/// Weights uniform in +-sqrt(6 / (fan in + fan out)) (Glorot and Bengio 2010), biases zero.
Network make_network(const Architecture& architecture, std::uint64_t seed);

}  // namespace pcednet::nn
