#pragma once

#include <span>
#include <vector>

#include "pcednet/core/progress.h"
#include "pcednet/nn/kernels.h"
#include "pcednet/nn/model.h"

namespace pcednet::nn {

/// The probability of every class for every sample.
///
/// `samples` is n x scales x features, raw; the result is n x classes, each row summing to 1 (to
/// rounding). A sample's row depends on that sample alone, and has the same bytes on every
/// processor. Throws Error(kUsage) if the sizes do not fit, Error(kCancelled).
std::vector<float> predict(const Model& model, std::span<const float> samples,
                           const Progress* progress = nullptr);

/// The same into the caller's memory (n x classes), with these vector instructions.
void predict_into(const Model& model, std::span<const float> samples,
                  std::span<float> probabilities, const Progress* progress = nullptr,
                  InstructionSet instructions = instruction_set());

}  // namespace pcednet::nn
