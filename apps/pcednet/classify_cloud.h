#pragma once

#include <CLI/CLI.hpp>
#include <filesystem>
#include <functional>
#include <vector>

#include "methods.h"
#include "pcednet/detect/classify.h"
#include "pcednet/detect/model.h"
#include "pcednet/detect/points/prepare.h"
#include "pcednet/gls/scale_space_options.h"

namespace pcednet::app {

/// Adds --keep-orientation.
void add_prepare_options(CLI::App& command, detect::PrepareOptions& options);

/// detect::prepare() with its notes as warnings and `file` in its errors.
detect::PreparedCloud prepare(const std::filesystem::path& file, const PointCloud& cloud,
                              const detect::PrepareOptions& options, const Progress& progress);

/// Warns of coordinates of this type that are rounded to more than the spacing, which is
/// `apart()`, found where it matters.
void warn_of_rounding(const std::filesystem::path& file, ScalarType type,
                      const detect::PreparedCloud& cloud, const gls::ScaleRange& range,
                      const std::function<double()>& apart);

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

/// Warns of points that are marked as deleted: they are labelled like all others.
void warn_of_withheld(const std::filesystem::path& file, const PointCloud& cloud);

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
