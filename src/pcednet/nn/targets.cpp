#include "pcednet/nn/targets.h"

#include <algorithm>

namespace pcednet::nn {

void fill_targets(const TrainingSet& set, std::span<const std::uint32_t> chosen, int classes,
                  LaneTable& targets) {
  for (int p = 0; p < targets.lanes(); ++p) {
    const std::size_t sample = chosen[std::min(static_cast<std::size_t>(p), chosen.size() - 1)];
    for (int c = 0; c < classes; ++c) {
      targets.row(c)[p] = set.targets.empty()
                              ? static_cast<float>(set.labels[sample] == c)
                              : set.targets[sample * static_cast<std::size_t>(classes) +
                                            static_cast<std::size_t>(c)];
    }
  }
}

}  // namespace pcednet::nn
