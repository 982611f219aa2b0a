#pragma once

#include <algorithm>
#include <cstdint>
#include <span>
#include <string>

#include "pcednet/cloud/class_table.h"
#include "pcednet/detect/model.h"
#include "pcednet/nn/train.h"

namespace pcednet::detect {

/// Of a network that tells pieces from wholes: whole, piece.
inline constexpr std::size_t kPieceOutputs = 2;

/// Whether networks learn from points with that label.
inline bool is_learnt_from(std::uint8_t label, const ClassTable& table) {
  return label < table.size();
}

/// The output of the model's network for `label`. Boundary counts as non-edge; with two edge
/// classes, so does smooth-edge.
inline std::uint8_t output_of(std::uint8_t label, const EdgeModel& model) {
  if (!is_learnt_from(label, model.table)) return nn::kIgnoredLabel;
  const auto& classes = model.classes;
  const auto found = std::find(classes.begin(), classes.end(), label);
  if (found != classes.end()) return static_cast<std::uint8_t>(found - classes.begin());
  const bool counts_as_non_edge = has_edges(model.table) && label <= kBoundary &&
                                  !classes.empty() && classes.front() == kNonEdge;
  return counts_as_non_edge ? 0 : nn::kIgnoredLabel;
}

/// The first of `classes`, the classes of a network's outputs, that does not occur in `outputs`, as
/// shown to users: "sharp-edge (2)". Empty if there is none.
inline std::string missing_class(std::span<const std::uint8_t> classes, const ClassTable& table,
                                 std::span<const std::uint8_t> outputs) {
  for (std::size_t c = 0; c < classes.size(); ++c) {
    if (std::find(outputs.begin(), outputs.end(), c) != outputs.end()) continue;
    return table[classes[c]].name + " (" + std::to_string(classes[c]) + ")";
  }
  return {};
}

/// The output of a context network, which knows the edge classes alone.
inline std::uint8_t context_output_of(std::uint8_t label, const EdgeModel& model) {
  return has_edges(model.table) && label > kBoundary ? nn::kIgnoredLabel : output_of(label, model);
}

}  // namespace pcednet::detect
