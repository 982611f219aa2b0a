#pragma once

#include <filesystem>
#include <optional>
#include <vector>

#include "methods.h"
#include "pcednet/detect/classify.h"
#include "pcednet/detect/model.h"
#include "pcednet/detect/prepare.h"
#include "pcednet/detect/thinned_cloud.h"

namespace pcednet::app {

/// A classification, and the prepared cloud that it comes from: both of the points that are left,
/// where thick noise was averaged.
struct ClassifiedCloud {
  std::optional<detect::ThinnedCloud> thinned;
  detect::PreparedCloud prepared;  ///< empty where a method classified
  detect::Classification found;
};

/// What was found of every point of the cloud, and the normals that were made, if any.
struct ClassifiedPoints {
  std::vector<Vec3> made;
  detect::Classification found;
};
ClassifiedPoints all_points(ClassifiedCloud&& classified);

/// formats::read_cloud(), with its warnings on stderr, and one of faces, which nothing uses.
PointCloud read_cloud(const std::filesystem::path& file);

/// detect::thin_noise() of a cloud whose normals are estimated, with a warning.
std::optional<detect::ThinnedCloud> thin_noise(const std::filesystem::path& file,
                                               const PointCloud& cloud,
                                               const detect::PrepareOptions& options,
                                               const Progress& progress);

/// How to classify: by `model`, then for boundary by geometry if `boundary`; without a model by the
/// method.
struct Classifier {
  const detect::EdgeModel* model = nullptr;
  MethodArguments method = {};
  detect::PrepareOptions preparation = {};
  bool boundary = true;
};

/// Notes are warnings that name `file`.
ClassifiedCloud classify_cloud(const std::filesystem::path& file, const PointCloud& cloud,
                               const Classifier& classifier, const Progress& progress);

}  // namespace pcednet::app
