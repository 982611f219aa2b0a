#pragma once

#include <span>
#include <string_view>

namespace pcednet::gls {

/// The features that describe a point at a scale; each enumerator's name ends in their number.
enum class FeatureSet {
  kAll28,       ///< all: kInvariant7, then eta and the Jacobian entries that rotate with the cloud
  kInvariant7,  ///< kPaper6 and k2
  kPaper6,      ///< tau kappa k1 dtau dkappa phi
  kSpatial4,    ///< tau kappa k1 phi: no scale derivatives
  kRelief3,     ///< tau dtau phi
};

/// All sets of features, the largest first.
std::span<const FeatureSet> feature_sets();

int feature_count(FeatureSet set);

/// Their names, in the order of a matrix's columns.
std::span<const std::string_view> feature_names(FeatureSet set);

}  // namespace pcednet::gls
