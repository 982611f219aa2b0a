#pragma once

#include <cstdint>
#include <filesystem>
#include <string>
#include <vector>

#include "pcednet/cloud/point_cloud.h"

namespace pcednet::annotate {

/// A class that points have in the input.
struct FileClass {
  std::uint8_t id = 0;
  std::string name = {};
  Rgb colour = {};
  std::size_t points = 0;
};

/// The classes that the input gives its points.
struct FileClasses {
  std::vector<std::uint8_t> ids = {};   ///< one per point, kUnlabelled: none; empty: none at all
  std::vector<FileClass> classes = {};  ///< those that points have, by id
  bool are_predicted = false;           ///< by pcednet: to look at, not to learn from
};

/// The labels that `cloud`, read from `file`, came with: of a result those that were painted or of
/// its input, or else its own; otherwise those in any column that formats::labels_of() and
/// edge_column_of() know.
FileClasses file_labels(const PointCloud& cloud, const std::filesystem::path& file);

/// The field Classification of LAS, also as CloudCompare names it, with the names of the standard,
/// such as "2 ground". None if it has fewer than two classes.
FileClasses las_classes(const PointCloud& cloud);

/// A prediction of sharp-edge compared with a label: 0 true negative, 1 true positive, 2 false
/// positive, 3 false negative; kUnlabelled if one of the two is.
std::uint8_t error_of(std::uint8_t predicted, std::uint8_t label);

}  // namespace pcednet::annotate
