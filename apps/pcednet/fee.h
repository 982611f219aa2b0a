#pragma once

#include <filesystem>
#include <optional>

#include "pcednet/cloud/point_cloud.h"
#include "pcednet/core/progress.h"
#include "workbench/classic/edge_measure.h"

namespace pcednet::app {

/// Radii in the cloud's unit; by default fractions of the diagonal of its bounding box.
struct FeeOptions {
  std::optional<double> offset_radius = {};       ///< R; none: 0.05 of the diagonal
  std::optional<double> convolution_radius = {};  ///< r; none: half of R
  double threshold = 0.16;
};

/// The program pcednet-fee beside this one, or on the PATH; empty if it was not built.
std::filesystem::path find_fee();

/// Feature edge estimation (Merigot, Ovsjanikov, Guibas 2011): the ratio l1 / (l0 + l1 + l2) of the
/// eigenvalues l0 <= l1 <= l2 of the Voronoi covariance measure, by pcednet-fee. Throws
/// Error(kInsufficient) if that program is missing, Error(kFailure) if it fails, Error(kUsage) for
/// a radius that is not above zero.
classic::EdgeMeasure feature_edge_estimation(const PointCloud& cloud, const FeeOptions& options,
                                             const Progress* progress);

}  // namespace pcednet::app
