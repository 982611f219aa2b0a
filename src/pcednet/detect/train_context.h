#pragma once

#include <functional>
#include <span>

#include "pcednet/detect/train.h"

namespace pcednet::detect {

/// Trains a context network for the model, unless the model's own training was cancelled:
/// classifies the clouds with the model and learns from the predictions around their labelled
/// points. `options` as for the model's own network; its architecture and symmetry are not used.
/// After a cancel the model has the best context network so far, or none. If none could be
/// trained TrainedModel::no_context has the reason; that there are no edge classes is a note.
void add_context(TrainedModel& trained, std::span<const TrainingCloud> clouds,
                 const TrainOptions& options,
                 const std::function<void(const nn::EpochReport&)>& on_epoch = {},
                 const Progress* progress = nullptr);

}  // namespace pcednet::detect
