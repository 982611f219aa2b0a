#pragma once

#include <functional>
#include <span>

#include "pcednet/detect/train.h"

namespace pcednet::detect {

/// Trains the context network of `model`, which has none yet: classifies the clouds with the model
/// and learns from what was found around their labelled points. `options` as for the model's own
/// network; its architecture and symmetry are not used. A cancel during the training proper gives
/// the best network so far, or one of no epoch.
nn::TrainResult train_context(const EdgeModel& model, std::span<const TrainingCloud> clouds,
                              const TrainOptions& options,
                              const std::function<void(const nn::EpochReport&)>& on_epoch = {},
                              const Progress* progress = nullptr);

}  // namespace pcednet::detect
