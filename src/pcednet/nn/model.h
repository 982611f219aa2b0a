#pragma once

#include <cstdint>
#include <map>
#include <string>
#include <vector>

#include "pcednet/nn/network.h"
#include "pcednet/nn/standardise.h"

namespace pcednet::nn {

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
