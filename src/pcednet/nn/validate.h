#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "pcednet/nn/evaluator.h"
#include "pcednet/nn/train.h"

namespace pcednet::nn {

/// Macro averages: means over the classes of the means over each class's samples.
struct Validation {
  double loss = 0.0;      ///< cross-entropy, the classes weighted
  double accuracy = 0.0;  ///< share of samples whose most probable class is their own
  /// Confusion counts, true class by row, predicted class by column; classes x classes.
  std::vector<std::size_t> confusion = {};
};

/// Judges a model on the samples `chosen` (indices into `set`, none of them ignored). `weights`:
/// of each class in the loss, in any unit.
Validation validate(const Model& model, const TrainingSet& set,
                    std::span<const std::uint32_t> chosen, std::span<const double> weights);

}  // namespace pcednet::nn
