#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "pcednet/detect/classify.h"

namespace pcednet::detect {

/// Writes a network's answers for `points`, each listed once, into `found`: an edge where
/// sharp-edge and smooth-edge together are more probable than not, of the more probable kind.
/// `probabilities` has a row per point, with a number for each of `classes`, the EdgeClass of the
/// network's outputs.
void decide(std::span<const std::uint32_t> points, std::span<const float> probabilities,
            const std::vector<std::uint8_t>& classes, Classification& found);

/// The same for the outputs of any model. With own classes, the most probable class wins, where
/// both kinds of edge together compete with non-edge and each own class.
void decide(std::span<const std::uint32_t> points, std::span<const float> probabilities,
            const EdgeModel& model, Classification& found);

ClassCounts count_classes(const std::vector<std::uint8_t>& classes);

}  // namespace pcednet::detect
