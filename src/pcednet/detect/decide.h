#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "pcednet/detect/classify.h"

namespace pcednet::detect {

/// Throws Error(kUsage) if the result is not one of this many points.
void check_size(const Classification& found, std::size_t points);

/// A result in which all `points` points are unlabelled, for a model with own classes or with edge
/// classes only.
Classification nothing_found(std::size_t points, bool has_own_classes = false);

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
