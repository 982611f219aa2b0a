#pragma once

#include "pcednet/nn/train.h"

namespace pcednet::nn {

/// Trains `teachers` networks that differ only by their seeds, then one network on their targets,
/// the probabilities of their mean log-odds (distillation). This averages out chance results of
/// single networks, at the running cost of one. Without teachers it is train(); otherwise it is as
/// train(), with `on_epoch` called for every network. After a cancel the result is the network in
/// training.
TrainResult distil(const Architecture& architecture, const TrainingSet& set,
                   const TrainOptions& options, int teachers,
                   const std::function<void(const EpochReport&)>& on_epoch = {},
                   const Progress* progress = nullptr);

}  // namespace pcednet::nn
