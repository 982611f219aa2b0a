#pragma once

#include <array>
#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "pcednet/cloud/point_cloud.h"

namespace pcednet::detect {

/// The columns in which a result keeps a truth: the labels that the annotator painted or that were
/// changed in Python, and those of the input that was classified. The first that labels a point
/// counts.
inline constexpr const char* kPaintedLabels = "scalar_painted_label";
inline constexpr const char* kInputLabels = "scalar_input_label";
inline constexpr std::array<const char*, 2> kTruthColumns = {kPaintedLabels, kInputLabels};

/// The columns by which a result is known where another program dropped its comments: the classes,
/// which are also its labels, and the probabilities.
inline constexpr std::array<const char*, 3> kResultColumns = {"scalar_edge_class", "scalar_p_sharp",
                                                              "scalar_p_smooth"};

/// Whether the cloud has all of these, with one number each. Needs no points.
bool has_result_columns(const PointCloud& cloud);
/// Whether its comments name the model of a result.
bool names_model(const PointCloud& cloud);

/// What a result holds to learn from and to score against.
struct ResultTruth {
  std::vector<std::uint8_t> labels = {};  ///< one per point; empty if there are none but its own
  std::string note = {};                  ///< where they come from, for the user
};

/// The truth that `cloud` holds if its comments name a model, or it has all of kResultColumns, so
/// that its own labels are predictions: the labels of the first of kTruthColumns that labels a
/// point, whole numbers up to 255 of any type. Otherwise, if classes and labels of the result
/// differ, those that agree less with the probabilities, as they were corrected. None if the cloud
/// is no result. Reads the comments, the labels and these columns alone.
std::optional<ResultTruth> truth_of_result(const PointCloud& cloud);

}  // namespace pcednet::detect
