#pragma once

#include <cstddef>
#include <cstdint>
#include <span>

namespace pcednet::nn {

/// The label of samples to leave out.
constexpr std::uint8_t kIgnoredLabel = 255;

/// Samples with the class of each; not owned.
struct TrainingSet {
  std::span<const float> samples;        ///< n x scales x features, row-major
  std::span<const std::uint8_t> labels;  ///< n; a class, or kIgnoredLabel
  /// n x classes, the probabilities to learn; empty: from the labels.
  std::span<const float> targets = {};
};

}  // namespace pcednet::nn
