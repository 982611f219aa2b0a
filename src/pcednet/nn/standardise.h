#pragma once

#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

#include "pcednet/nn/training_set.h"

namespace pcednet::nn {

/// What happens to inputs far from the mean.
enum class Squash {
  kClip,  ///< u limited to +-bound
  kSoft,  ///< u / (1 + |u| / bound): keeps the order of large values
};

/// Brings every input x to about the range the sigmoids resolve: u = (x - mean) / deviation, then
/// squashed. Inputs that are not finite become 0.
struct Standardisation {
  std::vector<float> mean;               ///< per scale and feature
  std::vector<float> inverse_deviation;  ///< the same
  float bound = 5.0f;
  Squash squash = Squash::kClip;
};

/// Inputs as they are, but for a limit of 1e6 that keeps the network's sums finite.
Standardisation no_standardisation(int inputs);

struct StandardisationOptions {
  float bound = 5.0f;
  Squash squash = Squash::kClip;
  double tail = 0.005;  ///< the share of values at either end that is cut before measuring
  std::size_t most_samples = 20000;  ///< looked at per class
};

/// Measures mean and deviation over the finite values of the labelled samples, every class counting
/// the same, after cutting the tails. An input that hardly varies is divided by a floor of 1e-6.
///
/// `odd` (per feature, or empty) marks features that change sign with the normals: their mean is 0
/// by symmetry and their deviation is the root of the mean square.
Standardisation measure_standardisation(const TrainingSet& set, int scales, int features,
                                        std::span<const std::uint8_t> odd,
                                        const StandardisationOptions& options = {});

}  // namespace pcednet::nn
