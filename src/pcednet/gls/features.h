#pragma once

#include <span>
#include <string_view>

namespace pcednet::gls {

struct Descriptor;

/// Which numbers describe a point at a scale; the count is the enumerator's.
enum class FeatureSet {
  kAll28,  ///< everything: kInvariant7, then eta and the Jacobian entries that turn with the cloud
  kInvariant7,  ///< kPaper6 and k2
  kPaper6,      ///< tau kappa k1 dtau dkappa phi
  kSpatial4,    ///< tau kappa k1 phi: no scale derivatives
  kRelief3,     ///< tau dtau phi
};

int feature_count(FeatureSet set);

/// Their names, in the order of a matrix's columns.
std::span<const std::string_view> feature_names(FeatureSet set);

/// Writes the features of `set`, made free of units by the support radius t: lengths are divided by
/// t, curvatures multiplied by it, a derivative in x or t by one more t.
/// `out` has feature_count(set) numbers.
void write_features(FeatureSet set, const Descriptor& descriptor, double t, std::span<double> out);

}  // namespace pcednet::gls
