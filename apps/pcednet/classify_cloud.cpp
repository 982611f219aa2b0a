#include "classify_cloud.h"

#include <fmt/format.h>

#include <utility>

#include "common.h"
#include "descriptor_options.h"
#include "pcednet/cloud/bounding_box.h"
#include "pcednet/detect/boundary.h"
#include "pcednet/detect/rounding.h"
#include "pcednet/formats/cloud_facts.h"
#include "pcednet/formats/read_cloud.h"
#include "pcednet/io/faces.h"
#include "prepare.h"

namespace pcednet::app {
namespace {

/// Warns of coordinates of this type that are rounded too coarsely.
void warn_of_rounding(const std::filesystem::path& file, ScalarType type, const BoundingBox& bounds,
                      const gls::ScaleRange& range, const ClassifiedCloud& classified) {
  if (!detect::may_be_too_coarse(type, classified.prepared.decision, range)) return;
  const std::string note = formats::note_on_float(bounds, classified.found.s_min);
  if (!note.empty()) warn(fmt::format("{}: {}", file.string(), note));
}

}  // namespace

PointCloud read_cloud(const std::filesystem::path& file) {
  auto loaded = formats::read_cloud(file);
  warn_all(file, loaded.warnings);
  if (const std::size_t faces = io::face_count(loaded.cloud)) {
    warn(
        fmt::format("{}: {} faces are not used, only their vertices: pcednet convert --sample N "
                    "samples points on faces",
                    file.string(), faces));
  }
  return std::move(loaded.cloud);
}

ClassifiedCloud classify_cloud(const std::filesystem::path& file, const PointCloud& cloud,
                               const Classifier& classifier, const Progress& progress) {
  ClassifiedCloud result;
  if (classifier.model) {
    result.prepared = prepare(file, cloud, classifier.preparation, progress);
    const BoundingBox bounds = bounding_box(result.prepared.positions);
    check_scales(file, bounds, classifier.model->descriptor);
    result.found = detect::classify(result.prepared, *classifier.model, &progress);
    if (classifier.boundary && has_edges(classifier.model->table)) {
      detect::mark_boundary(result.prepared, result.found, &progress);
    }
    warn_of_rounding(file, cloud.position_type, bounds, classifier.model->descriptor.range, result);
  } else {
    result.found = classify_by_method(cloud, classifier.method, &progress);
  }
  if (!result.found.note.empty()) warn(fmt::format("{}: {}", file.string(), result.found.note));
  return result;
}

}  // namespace pcednet::app
