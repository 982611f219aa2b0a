#include "pcednet/nn/network.h"

#include <cmath>

#include "pcednet/core/random.h"
#include "pcednet/nn/plan.h"

namespace pcednet::nn {

Network make_network(const Architecture& architecture, std::uint64_t seed) {
  const Plan plan = make_plan(architecture);
  Network network{architecture, std::vector<float>(plan.parameters, 0.0f)};
  Random random(seed);
  for (const Layer& layer : plan.layers) {
    const double bound = std::sqrt(6.0 / (layer.fan_in + layer.fan_out));
    for (std::size_t i = layer.weight; i < layer.bias; ++i) {
      network.parameters[i] = static_cast<float>(random.uniform(-bound, bound));
    }
  }
  return network;
}

}  // namespace pcednet::nn
