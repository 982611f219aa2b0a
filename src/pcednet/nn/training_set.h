#pragma once

#include <cstddef>
#include <cstdint>
#include <span>

namespace pcednet::nn {

/// A label that says nothing: such samples are left out.
constexpr std::uint8_t kIgnoredLabel = 255;

/// Samples with the class of each; both are only looked at.
struct TrainingSet {
  std::span<const float> samples;        ///< n x scales x features, row-major
  std::span<const std::uint8_t> labels;  ///< n; a class, or kIgnoredLabel
  /// n x classes, the probabilities to learn; or empty: those that the labels say.
  std::span<const float> targets = {};
};

}  // namespace pcednet::nn
