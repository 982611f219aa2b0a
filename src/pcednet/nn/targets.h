#pragma once

#include <cstdint>
#include <span>

#include "pcednet/nn/kernels.h"
#include "pcednet/nn/training_set.h"

namespace pcednet::nn {

/// Writes what is wanted of the samples `chosen`, a row per class and a lane per sample; lanes that
/// are left over repeat the last. `smoothing` is the share that goes to all classes alike.
void fill_targets(const TrainingSet& set, std::span<const std::uint32_t> chosen, float smoothing,
                  int classes, LaneTable& targets);

}  // namespace pcednet::nn
