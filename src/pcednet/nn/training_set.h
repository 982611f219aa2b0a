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
};

}  // namespace pcednet::nn
