#pragma once

#include <CLI/CLI.hpp>
#include <filesystem>
#include <optional>
#include <string>

#include "pcednet/cloud/point_cloud.h"
#include "pcednet/core/progress.h"
#include "pcednet/detect/classify.h"
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

/// A method that needs no model, and its settings; 0 and negative: the method's default.
struct MethodArguments {
  std::string name;
  int neighbours = 0;
  double threshold = -1.0;
  double offset_radius = 0.0, convolution_radius = 0.0;
};

/// Adds --method, --neighbours, --threshold, --offset-radius and --convolution-radius.
void add_method_options(CLI::App& command, MethodArguments& arguments);

/// Classes by the method: sharp-edge or non-edge. p_sharp is v / (v + threshold) for its value v,
/// so that 0.5 is the threshold. Throws Error(kUsage) where an option does not go with the method.
detect::Classification classify_by_method(const PointCloud& cloud, const MethodArguments& arguments,
                                          const Progress* progress);

}  // namespace pcednet::app
