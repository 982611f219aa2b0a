#pragma once

#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

#include "pcednet/nn/training_set.h"

namespace pcednet::nn {

/// Brings every input x to about the range the sigmoids resolve: u = (x - mean) / deviation,
/// limited to +-bound. Inputs that are not finite become 0.
struct Standardisation {
  std::vector<float> mean;               ///< per scale and feature
  std::vector<float> inverse_deviation;  ///< the same
  float bound = 5.0f;
};

/// Inputs as they are, but for a limit of 1e6 that keeps the network's sums finite.
Standardisation no_standardisation(int inputs);

/// Measures mean and deviation over the finite values of the labelled samples, every class counting
/// the same, after cutting half a percent at either end. At most 20,000 samples of a class are
/// looked at. An input that hardly varies is divided by a floor of 1e-6.
///
/// `odd` (per feature, or empty) marks features that change sign with the normals: their mean is 0
/// by symmetry and their deviation is the root of the mean square.
Standardisation measure_standardisation(const TrainingSet& set, int scales, int features,
                                        std::span<const std::uint8_t> odd);

}  // namespace pcednet::nn
