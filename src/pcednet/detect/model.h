#pragma once

#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <limits>
#include <optional>
#include <string>
#include <vector>

#include "pcednet/cloud/class_table.h"
#include "pcednet/core/output_file.h"
#include "pcednet/gls/scale_space_options.h"
#include "pcednet/nn/model.h"

namespace pcednet::detect {

/// Points with a lower edge probability skip the context network and stay non-edge. These are most
/// points, so most of its time is saved.
inline constexpr float kLeastEdge = 0.01f;

/// Facts about a cloud before its points are classified.
struct CloudTraits {
  std::size_t points =
      std::numeric_limits<std::size_t>::max();  ///< distinct; the maximum unless counted
  bool estimated = false;  ///< normals were missing and are estimated, or (below 20,000 points) the
                           ///< given ones agree with estimated ones
  bool exact = false;      ///< normals were missing, and the points lie on surfaces without noise
  bool noisy = false;      ///< normals were missing, and noise requires more neighbours than usual
};

/// The kind of clouds that an expert is for: all conditions must hold.
struct CloudKind {
  std::size_t below = 0;  ///< distinct points; 0: of any number
  std::optional<bool> estimated = {};
  bool exact = false;
  bool noisy = false;

  bool has(const CloudTraits& traits) const;
  bool operator==(const CloudKind&) const = default;
};

/// The networks that replace a model's own for clouds of one kind, with the same description and
/// classes.
struct Expert {
  CloudKind kind = {};
  nn::Model network = {};
  std::optional<nn::Model> context = {};
};

/// A network and the descriptor it was trained with: all that is needed to classify a cloud.
/// Features of a scale without a fit are 0, in training and in use.
struct EdgeModel {
  std::string name;
  std::uint64_t seed = 0;
  gls::ScaleSpaceOptions descriptor;  ///< s_min and s_max are each cloud's own
  /// The class of every output, ascending numbers of `table`. With edge classes only, {0, 1, 2} or
  /// {0, 2}, an EdgeClass each.
  std::vector<std::uint8_t> classes;
  nn::Model network;                      ///< its metadata summarises the training
  std::optional<nn::Model> context = {};  ///< decides last, from a ContextMatrix
  ClassTable table = edge_classes();      ///< indexed by `classes`
  /// The context network decides on points with at least this edge probability.
  float least_edge = kLeastEdge;
  std::vector<Expert> experts = {};  ///< the first whose kind matches the cloud decides
  /// Says whether a description is from a whole thing (output 0) or a piece of a larger cloud (1).
  /// Where experts would decide for few points, a cloud of pieces counts as large. Only with
  /// experts.
  std::optional<nn::Model> pieces = {};
};

/// Those of `classes` that the context network decides on: the edge classes; none if the table has
/// no edge classes.
std::vector<std::uint8_t> edge_outputs(const EdgeModel& model);

/// The expert that decides for such a cloud; nullptr if the model's own networks do.
const Expert* expert_for(const EdgeModel& model, const CloudTraits& traits);

/// The model reduced to the networks that decide for such a cloud. classify() does this by itself;
/// call it to inspect the networks or continue their training.
EdgeModel suited_to(EdgeModel model, const CloudTraits& traits);

/// Removes the context networks: faster, less accurate.
void drop_context(EdgeModel& model);

/// Throws Error(kModelMismatch) unless the networks of `expert` use `descriptor`, but for octaves,
/// which they may have learnt without, and have that many classes.
void check_fits(const EdgeModel& expert, const gls::ScaleSpaceOptions& descriptor,
                std::size_t classes);

/// Throws Error(kModelMismatch) unless the classes of `expert` are those of `table`.
void check_classes(const EdgeModel& expert, const ClassTable& table);

/// Adds `expert` for clouds of that kind; earlier experts take precedence. Throws what both checks
/// throw, and Error(kModelMismatch) if its networks know others of the classes.
void join_expert(EdgeModel& model, const EdgeModel& expert, const CloudKind& kind);

/// Reads a model file. Throws Error(kUnreadable) if there is none, Error(kModelMismatch), naming
/// file and place, if it is damaged, not an edge model, or for a descriptor other than this
/// version's.
EdgeModel load_model(const std::filesystem::path& path);

/// Writes a safetensors file; the same model gives the same bytes. The context network's tensors
/// and metadata have the network's names with the prefix "context."; those of the experts have the
/// prefixes "expert1.", "expert2." and so on, and "kind" among their metadata; those of the network
/// for pieces have the prefix "pieces.".
void save_model(const std::filesystem::path& path, const EdgeModel& model, Overwrite overwrite);

}  // namespace pcednet::detect
