#pragma once

#include <cstdint>
#include <filesystem>
#include <optional>
#include <string>
#include <vector>

#include "pcednet/core/output_file.h"
#include "pcednet/gls/scale_space_options.h"
#include "pcednet/nn/model.h"

namespace pcednet::detect {

/// A network with the description of points that it was trained on: all that is needed to classify
/// a cloud. Where a scale has no fit its features are 0, in training and in use.
struct EdgeModel {
  std::string name;
  std::uint64_t seed = 0;
  gls::ScaleSpaceOptions descriptor;      ///< s_min and s_max are each cloud's own
  std::vector<std::uint8_t> classes;      ///< EdgeClass of every output: {0, 1, 2} or {0, 2}
  nn::Model network;                      ///< its metadata holds the summary of the training
  std::optional<nn::Model> context = {};  ///< decides in the end, on a ContextMatrix
};

/// Reads a model file. Throws Error(kUnreadable) if there is none, Error(kModelMismatch), naming
/// file and place, if it is damaged, no model of edges, or for another descriptor than this
/// version's.
EdgeModel load_model(const std::filesystem::path& path);

/// Writes a safetensors file; the same model gives the same bytes. The context network's tensors
/// and metadata are named as the network's own, with "context." before them.
void save_model(const std::filesystem::path& path, const EdgeModel& model, Overwrite overwrite);

}  // namespace pcednet::detect
