#pragma once

#include <algorithm>
#include <cstdint>
#include <vector>

#include "pcednet/cloud/point_cloud.h"
#include "pcednet/nn/training_set.h"

namespace pcednet::detect {

/// Whether networks learn from points of that label.
inline bool is_learnt_from(std::uint8_t label) {
  return label <= kBoundary;
}

/// The output of a network that stands for `label`, given the EdgeClass of each. Boundary counts as
/// non-edge, with two classes smooth-edge as well.
inline std::uint8_t output_of(std::uint8_t label, const std::vector<std::uint8_t>& classes) {
  if (!is_learnt_from(label)) return nn::kIgnoredLabel;
  const auto found = std::find(classes.begin(), classes.end(), label);
  return found == classes.end() ? 0 : static_cast<std::uint8_t>(found - classes.begin());
}

}  // namespace pcednet::detect
