#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "pcednet/detect/classify.h"

namespace pcednet::detect {

/// Writes a network's answers for `points` into `found`: an edge where sharp-edge and smooth-edge
/// together are more probable than non-edge, of the more probable kind. `probabilities` has a row
/// for each of them, each of which comes once, a number for each of `classes`, the EdgeClass of the
/// network's outputs.
void decide(std::span<const std::uint32_t> points, std::span<const float> probabilities,
            const std::vector<std::uint8_t>& classes, Classification& found);

/// The same for the outputs of any model: the most probable class. Edges together stand against
/// non-edge and each of the model's own classes.
void decide(std::span<const std::uint32_t> points, std::span<const float> probabilities,
            const EdgeModel& model, Classification& found);

ClassCounts count_classes(const std::vector<std::uint8_t>& classes);

}  // namespace pcednet::detect
