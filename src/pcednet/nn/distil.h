#pragma once

#include "pcednet/nn/train.h"

namespace pcednet::nn {

/// Trains `teachers` networks that differ by their seeds alone, and then one on their opinion: the
/// targets are the probabilities of their mean log-odds. What one network found by chance is
/// evened out, at the cost of one in use. With no teachers it is train(); otherwise as train(),
/// `on_epoch` being told of every network. After a cancel the result is the network that was being
/// trained.
TrainResult distil(const Architecture& architecture, const TrainingSet& set,
                   const TrainOptions& options, int teachers,
                   const std::function<void(const EpochReport&)>& on_epoch = {},
                   const Progress* progress = nullptr);

}  // namespace pcednet::nn
