#include "classify_cloud.h"

#include <fmt/format.h>

#include <utility>

#include "common.h"
#include "pcednet/detect/boundary.h"
#include "pcednet/formats/read_cloud.h"
#include "prepare.h"

namespace pcednet::app {

PointCloud read_cloud(const std::filesystem::path& file) {
  auto loaded = formats::read_cloud(file);
  for (const std::string& warning : loaded.warnings) {
    warn(fmt::format("{}: {}", file.string(), warning));
  }
  return std::move(loaded.cloud);
}

ClassifiedCloud classify_cloud(const std::filesystem::path& file, const PointCloud& cloud,
                               const Classifier& classifier, const Progress& progress) {
  ClassifiedCloud result;
  if (classifier.model) {
    result.prepared = prepare(file, cloud, classifier.preparation, progress);
    result.found = detect::classify(result.prepared, *classifier.model, &progress);
    if (classifier.boundary && has_edges(classifier.model->table)) {
      detect::mark_boundary(result.prepared, result.found, &progress);
    }
  } else {
    result.found = classify_by_method(cloud, classifier.method, &progress);
  }
  if (!result.found.note.empty()) warn(fmt::format("{}: {}", file.string(), result.found.note));
  return result;
}

}  // namespace pcednet::app
