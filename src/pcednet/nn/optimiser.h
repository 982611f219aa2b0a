#pragma once

#include <cstddef>
#include <span>
#include <vector>

#include "pcednet/nn/train.h"

namespace pcednet::nn {

/// Moves parameters against their gradient. Uses only exactly rounded operations, so its bytes are
/// the same on every processor.
class Optimiser {
 public:
  Optimiser(OptimiserKind kind, std::size_t parameters, double momentum);

  void step(std::span<const float> gradient, double rate, std::span<float> parameters);

 private:
  OptimiserKind kind_;
  float momentum_;
  double first_power_ = 1.0, second_power_ = 1.0;  // of the decay rates, for the bias correction
  std::vector<float> first_, second_;
};

/// The share of the full learning rate at `step` of `steps`: a linear rise over the first
/// twentieth, then a smooth fall to zero (3 t^2 - 2 t^3, which is nearly half a cosine).
double learning_rate_share(std::size_t step, std::size_t steps);

}  // namespace pcednet::nn
