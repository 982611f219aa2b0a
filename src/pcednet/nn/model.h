#pragma once

#include <cstdint>
#include <map>
#include <string>
#include <vector>

#include "pcednet/nn/network.h"
#include "pcednet/nn/standardise.h"

namespace pcednet::nn {

/// What makes the answer the same when all normals of a cloud are flipped, to the last bit.
enum class Symmetry {
  kNone,       ///< nothing: the answer depends on the side the normals point to
  kAverage,    ///< the logits of a sample and of its flipped twin are averaged (twice the work)
  kCanonical,  ///< of the two the one is used whose deciding feature sums to more than zero
};

/// How samples answer to flipped normals.
struct SignRule {
  Symmetry symmetry = Symmetry::kNone;
  std::vector<std::uint8_t> odd_features =
      {};                    ///< per feature: 1 if it changes sign; empty: none does
  int deciding_feature = 0;  ///< of kCanonical: summed over the scales
};

/// A trained network with all that is needed to use it on raw samples.
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
