#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "pcednet/detect/classify.h"
#include "pcednet/nn/model.h"

namespace pcednet::detect {

/// Lets a network answer for the points `targets`, whose descriptions are `rows`: the class of the
/// highest probability. `classes` are the EdgeClass of its outputs; `probabilities` is room to work
/// in.
void decide(const nn::Model& network, const std::vector<std::uint8_t>& classes,
            std::span<const float> rows, std::span<const std::uint32_t> targets,
            std::vector<float>& probabilities, Classification& result);

ClassCounts count_classes(const std::vector<std::uint8_t>& classes);

}  // namespace pcednet::detect
