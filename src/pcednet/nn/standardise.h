#pragma once

#include <cstdint>
#include <span>

#include "pcednet/nn/train.h"

namespace pcednet::nn {

/// Leaves inputs unchanged, except for a limit of 1e6 that keeps the network's sums finite.
Standardisation no_standardisation(int inputs);

/// Measures mean and deviation over the finite values of the labelled samples, with equal weight
/// for every class, after trimming half a percent at either end. Uses at most 20,000 samples of a
/// class. Deviations have a floor of 1e-6.
///
/// `odd` (per feature, or empty) marks features that change sign with the normals: their mean is 0
/// by symmetry and their deviation is the root of the mean square.
Standardisation measure_standardisation(const TrainingSet& set, int scales, int features,
                                        std::span<const std::uint8_t> odd);

}  // namespace pcednet::nn
