#pragma once

#include <cstdint>
#include <span>

#include "pcednet/nn/kernels.h"
#include "pcednet/nn/train.h"

namespace pcednet::nn {

/// Writes the target probabilities of the samples `chosen`, a row per class and a lane per sample;
/// spare lanes repeat the last.
void fill_targets(const TrainingSet& set, std::span<const std::uint32_t> chosen, int classes,
                  LaneTable& targets);

}  // namespace pcednet::nn
