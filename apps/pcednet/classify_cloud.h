#pragma once

#include <filesystem>
#include <vector>

#include "methods.h"
#include "pcednet/detect/classify.h"
#include "pcednet/detect/model.h"
#include "pcednet/detect/prepare.h"

namespace pcednet::app {

/// A classification, and the prepared cloud that it comes from: both of the averages, where thick
/// noise was averaged.
struct ClassifiedCloud {
  detect::PreparedCloud prepared;  ///< empty where a method classified
  detect::Classification found;
};

/// What was found of every point of the cloud, and the normals that were made, if any.
struct ClassifiedPoints {
  std::vector<Vec3> made;
  detect::Classification found;
};
ClassifiedPoints all_points(ClassifiedCloud&& classified);

/// formats::read_cloud(), with its warnings on stderr, and one of faces, which nothing uses; of
/// results that lost their comments, estimated normals are marked.
PointCloud read_cloud(const std::filesystem::path& file, const Progress* progress = nullptr);

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
