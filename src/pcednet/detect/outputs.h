#pragma once

#include <algorithm>
#include <cstdint>
#include <vector>

#include "pcednet/cloud/point_cloud.h"
#include "pcednet/nn/training_set.h"

namespace pcednet::detect {

/// The output of a network that stands for `label`, given the EdgeClass of each; with two classes
/// smooth-edge counts as non-edge. What is no edge class is not learnt from.
inline std::uint8_t output_of(std::uint8_t label, const std::vector<std::uint8_t>& classes) {
  if (label > kSharpEdge) return nn::kIgnoredLabel;
  const auto found = std::find(classes.begin(), classes.end(), label);
  return found == classes.end() ? 0 : static_cast<std::uint8_t>(found - classes.begin());
}

}  // namespace pcednet::detect
