#include "classify_cloud.h"

#include <fmt/format.h>

#include <utility>

#include "common.h"
#include "descriptor_options.h"
#include "pcednet/cloud/bounding_box.h"
#include "pcednet/detect/boundary.h"
#include "pcednet/formats/cloud_facts.h"
#include "pcednet/formats/read_cloud.h"
#include "pcednet/io/faces.h"
#include "prepare.h"

namespace pcednet::app {
namespace {

/// Warns of float32 coordinates that are rounded too coarsely, unless prepare() has spread them.
void warn_of_rounding(const std::filesystem::path& file, const PointCloud& cloud,
                      const BoundingBox& bounds, const ClassifiedCloud& classified) {
  if (cloud.position_type != ScalarType::kFloat32) return;
  if (classified.prepared.decision.rounding.step > 0.0) return;
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
    const bool is_spacing = classifier.model->descriptor.range.s_min == 0.0;  // what s_min is then
    if (is_spacing) warn_of_rounding(file, cloud, bounds, result);
  } else {
    result.found = classify_by_method(cloud, classifier.method, &progress);
  }
  if (!result.found.note.empty()) warn(fmt::format("{}: {}", file.string(), result.found.note));
  return result;
}

}  // namespace pcednet::app
