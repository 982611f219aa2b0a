#include "pcednet/nn/optimiser.h"

#include <algorithm>
#include <cmath>

namespace pcednet::nn {

Optimiser::Optimiser(OptimiserKind kind, std::size_t parameters, double momentum)
    : kind_(kind),
      momentum_(static_cast<float>(momentum)),
      first_(parameters, 0.0f),
      second_(kind == OptimiserKind::kAdam ? parameters : 0, 0.0f) {}

void Optimiser::step(std::span<const float> gradient, double rate, std::span<float> parameters) {
  if (kind_ == OptimiserKind::kMomentum) {
    const auto r = static_cast<float>(rate);
    for (std::size_t i = 0; i < parameters.size(); ++i) {
      first_[i] = momentum_ * first_[i] + gradient[i];
      parameters[i] -= r * first_[i];
    }
    return;
  }
  constexpr float kSecond = 0.999f;
  first_power_ *= momentum_;
  second_power_ *= kSecond;
  const auto r = static_cast<float>(rate / (1.0 - first_power_));
  const auto correction = static_cast<float>(1.0 / (1.0 - second_power_));
  for (std::size_t i = 0; i < parameters.size(); ++i) {
    const float g = gradient[i];
    first_[i] = momentum_ * first_[i] + (1.0f - momentum_) * g;
    second_[i] = kSecond * second_[i] + (1.0f - kSecond) * (g * g);
    parameters[i] -= r * first_[i] / (std::sqrt(second_[i] * correction) + 1e-8f);
  }
}

double learning_rate_share(std::size_t step, std::size_t steps) {
  const std::size_t warm_up = steps / 20;
  if (step < warm_up) return static_cast<double>(step + 1) / static_cast<double>(warm_up);
  const double t = static_cast<double>(steps - step) / static_cast<double>(steps - warm_up);
  return t * t * (3.0 - 2.0 * t);
}

}  // namespace pcednet::nn
