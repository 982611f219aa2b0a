#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <map>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

namespace pcednet::nn {

enum class NetworkKind {
  kPcednet,  ///< scales are joined pair by pair, each pair in a dense layer of its own
  kFc,       ///< the same neurons, every layer connected to all of the one before
  kCnn,      ///< two 1D convolutions over the features, with the scales as channels
};

/// Their names in options.
inline constexpr std::array<std::pair<std::string_view, NetworkKind>, 3> kNetworkKinds = {
    {{"pcednet", NetworkKind::kPcednet}, {"fc", NetworkKind::kFc}, {"cnn", NetworkKind::kCnn}}};

/// The shape of a network: everything but its weights.
///
/// With 16 scales, 6 features, 3 classes and the default widths: PCEDNet has 1623 weights, FC 6663,
/// CNN 9723.
struct Architecture {
  NetworkKind kind = NetworkKind::kPcednet;
  int scales = 16;   ///< a power of two, at least 4
  int features = 6;  ///< numbers per scale
  int classes = 3;   ///< at least 2
  int width = 0;     ///< neurons per pair of scales; 0: as many as features. CNN: not used
  int hidden = 16;   ///< neurons of the classifier's two hidden layers. CNN: not used

  int inputs() const { return scales * features; }
  int pair_width() const { return width > 0 ? width : features; }
  bool operator==(const Architecture&) const = default;
};

/// The number of parameters, biases included.
std::size_t weight_count(const Architecture& architecture);

/// A shape and its weights, layer by layer: the weights of a layer (row-major), then its biases.
struct Network {
  Architecture architecture;
  std::vector<float> parameters;
};

/// Brings every input x to about the range the sigmoids resolve: u = (x - mean) / deviation,
/// limited to +-bound. Inputs that are not finite become 0.
struct Standardisation {
  std::vector<float> mean;               ///< per scale and feature
  std::vector<float> inverse_deviation;  ///< the same
  float bound = 5.0f;
};

/// How the answer is made invariant, to the last bit, under a flip of all normals of a cloud.
enum class Symmetry {
  kNone,       ///< not: the answer depends on the side the normals point to
  kAverage,    ///< the logits of a sample and of its flipped twin are averaged (twice the work)
  kCanonical,  ///< of the two, the one whose deciding feature has a positive sum is used
};

/// How features and network respond to flipped normals.
struct SignRule {
  Symmetry symmetry = Symmetry::kNone;
  std::vector<std::uint8_t> odd_features =
      {};                    ///< per feature: 1 if it changes sign; empty: none does
  int deciding_feature = 0;  ///< of kCanonical: summed over the scales
};

/// A trained network with everything needed to apply it to raw samples.
struct Model {
  Network network;
  Standardisation standardisation;
  SignRule sign_rule;
  std::vector<std::string> class_names;         ///< one per class
  std::map<std::string, std::string> metadata;  ///< the caller's: descriptor, seed, training, ...
};

/// Throws Error(kUsage) if the parts do not fit each other.
void check_consistent(const Model& model);

}  // namespace pcednet::nn
