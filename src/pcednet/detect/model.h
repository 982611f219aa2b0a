#pragma once

#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <optional>
#include <string>
#include <vector>

#include "pcednet/cloud/class_table.h"
#include "pcednet/core/output_file.h"
#include "pcednet/detect/cloud_kind.h"
#include "pcednet/gls/scale_space_options.h"
#include "pcednet/nn/model.h"

namespace pcednet::detect {

/// A point that is so sure to be no edge stays so: most points do, which saves most of the time.
inline constexpr float kLeastEdge = 0.01f;

/// What decides for clouds of one kind in place of a model's own networks, on the same description
/// and for the same classes.
struct Expert {
  CloudKind kind = {};
  nn::Model network = {};
  std::optional<nn::Model> context = {};
};

/// A network with the description of points that it was trained on: all that is needed to classify
/// a cloud. Where a scale has no fit its features are 0, in training and in use.
struct EdgeModel {
  std::string name;
  std::uint64_t seed = 0;
  gls::ScaleSpaceOptions descriptor;  ///< s_min and s_max are each cloud's own
  /// The class of every output, ascending numbers of `table`. Of edge classes alone {0, 1, 2} or
  /// {0, 2}, an EdgeClass each.
  std::vector<std::uint8_t> classes;
  nn::Model network;                      ///< its metadata holds the summary of the training
  std::optional<nn::Model> context = {};  ///< decides in the end, on a ContextMatrix
  ClassTable table = edge_classes();      ///< what `classes` are numbers of
  /// The context network decides on points of this probability of an edge or more.
  float least_edge = kLeastEdge;
  std::vector<Expert> experts = {};  ///< the first whose kind a cloud is of decides
};

/// Those of `classes` that the context network decides on: the edge classes, none of a table
/// without them.
std::vector<std::uint8_t> edge_outputs(const EdgeModel& model);

/// The expert that decides for such a cloud, or nullptr: the model's own networks do.
const Expert* expert_for(const EdgeModel& model, const CloudFacts& facts);

/// The model with those networks alone that decide for such a cloud. classify() does this by
/// itself; it is for those who look at or go on training the networks.
EdgeModel suited_to(EdgeModel model, const CloudFacts& facts);

/// Leaves the context networks out: faster, less accurate.
void drop_context(EdgeModel& model);

/// Throws Error(kModelMismatch) unless the networks of `expert` are for that description of points
/// and that many classes.
void check_fits(const EdgeModel& expert, const gls::ScaleSpaceOptions& descriptor,
                std::size_t classes);

/// Lets the networks of `expert` decide for clouds of a kind, unless an earlier one does. Throws
/// what check_fits() throws.
void join_expert(EdgeModel& model, const EdgeModel& expert, const CloudKind& kind);

/// Reads a model file. Throws Error(kUnreadable) if there is none, Error(kModelMismatch), naming
/// file and place, if it is damaged, no model of edges, or for another descriptor than this
/// version's.
EdgeModel load_model(const std::filesystem::path& path);

/// Writes a safetensors file; the same model gives the same bytes. The context network's tensors
/// and metadata are named as the network's own, with "context." before them; those of the experts
/// have "expert1.", "expert2." and so on before theirs, and "kind" among their metadata.
void save_model(const std::filesystem::path& path, const EdgeModel& model, Overwrite overwrite);

}  // namespace pcednet::detect
