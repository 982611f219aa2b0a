#pragma once

#include <span>

#include "pcednet/gls/scale_space_options.h"

namespace pcednet::gls {

struct Descriptor;

/// Writes the features of `set`, made dimensionless by the support radius t: lengths are divided by
/// t, curvatures multiplied by t, derivatives in x or t by one more t. `out` has feature_count(set)
/// numbers.
void write_features(FeatureSet set, const Descriptor& descriptor, double t, std::span<double> out);

}  // namespace pcednet::gls
