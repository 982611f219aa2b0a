#pragma once

#include <cstddef>
#include <cstdint>
#include <vector>

#include "pcednet/gls/pyramid_plan.h"

namespace pcednet::detect {

/// A part of a larger cloud, for points to get the same labels as in the whole.
struct PartOfCloud {
  /// Of the whole, one per octave in use; without levels if the exact engine describes.
  std::vector<gls::PyramidPlan> pyramids;
  std::size_t points = 0;                 ///< of the whole, distinct ones
  std::vector<std::uint8_t> wanted = {};  ///< 1: gets a label, 0: only a neighbour for others
};

}  // namespace pcednet::detect
