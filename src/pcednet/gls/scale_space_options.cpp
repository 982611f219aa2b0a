#include "pcednet/gls/scale_space_options.h"

#include <fmt/format.h>

namespace pcednet::gls {

std::string text_of(const ScaleSpaceOptions& options) {
  // Names every member, so that a new one does not compile before it has its place in the text.
  const auto& [scales, s_min, s_max, s_max_fraction, features, reconstruction, steps, side_gate,
               engine, eps] = options;
  return fmt::format(
      "scales {} s_min {} s_max {} fraction {} features {} reconstruction {} steps {} gate {} "
      "engine {} eps {}",
      scales, s_min, s_max, s_max_fraction, static_cast<int>(features),
      static_cast<int>(reconstruction), steps, side_gate ? fmt::format("{}", *side_gate) : "none",
      static_cast<int>(engine), eps);
}

}  // namespace pcednet::gls
