#include "classify_cloud.h"

#include <fmt/format.h>

#include <utility>

#include "batch.h"
#include "common.h"
#include "descriptor_options.h"
#include "pcednet/cloud/bounding_box.h"
#include "pcednet/detect/averages.h"
#include "pcednet/detect/boundary.h"
#include "pcednet/detect/estimates.h"
#include "pcednet/detect/points/rounding.h"
#include "pcednet/formats/cloud_facts.h"
#include "pcednet/formats/read_cloud.h"
#include "pcednet/io/las/facts.h"
#include "pcednet/io/ply/faces.h"

namespace pcednet::app {

void add_prepare_options(CLI::App& command, detect::PrepareOptions& options) {
  command.add_flag("--keep-orientation", options.keep_orientation,
                   "Use the normals of the file even if their signs are mixed");
}

detect::PreparedCloud prepare(const std::filesystem::path& file, const PointCloud& cloud,
                              const detect::PrepareOptions& options, const Progress& progress) {
  detect::PreparedCloud prepared;
  with_name_in_errors(file, [&] { prepared = detect::prepare(cloud, options, &progress); });
  warn_all(file, prepared.notes);
  if (prepared.reoriented) say("  --keep-orientation uses them as they are");
  if (prepared.misfits) say("  pcednet normals makes new ones");
  return prepared;
}

void warn_of_rounding(const std::filesystem::path& file, ScalarType type,
                      const detect::PreparedCloud& cloud, const gls::ScaleRange& range,
                      const std::function<double()>& apart) {
  if (!detect::may_be_too_coarse(type, cloud.decision, range)) return;
  with_name_in_errors(file, [&] {
    const std::string note =
        formats::note_on_float(bounding_box(cloud.positions), apart(),
                               detect::share_of_places(cloud.positions, cloud.curve));
    if (!note.empty()) warn(fmt::format("{}: {}", file.string(), note));
  });
}

PointCloud read_cloud(const std::filesystem::path& file, const Progress* progress) {
  auto loaded = read_whole(file);
  detect::mark_estimates(loaded.cloud, progress);
  warn_all(file, loaded.warnings);
  const std::string note = io::note_on_faces(loaded.cloud);
  if (!note.empty()) warn(fmt::format("{}: {}", file.string(), note));
  return std::move(loaded.cloud);
}

void warn_of_withheld(const std::filesystem::path& file, const PointCloud& cloud) {
  const std::string note = io::note_on_withheld(io::count_withheld(cloud), cloud.size());
  if (!note.empty()) warn(fmt::format("{}: {}", file.string(), note));
}

ClassifiedPoints all_points(ClassifiedCloud&& classified) {
  detect::PreparedCloud& prepared = classified.prepared;
  return {of_all_points(prepared, std::move(prepared.made)),
          of_all_points(prepared, std::move(classified.found))};
}

ClassifiedCloud classify_cloud(const std::filesystem::path& file, const PointCloud& cloud,
                               const Classifier& classifier, const Progress& progress) {
  ClassifiedCloud result;
  if (classifier.model) {
    detect::PrepareOptions preparation = classifier.preparation;
    preparation.average_noise = averages_noise(*classifier.model);
    result.prepared = prepare(file, cloud, preparation, progress);
    const BoundingBox bounds = bounding_box(result.prepared.positions);
    check_scales(file, bounds, classifier.model->descriptor);
    result.found = detect::classify(result.prepared, *classifier.model, &progress);
    if (classifier.boundary && has_edges(classifier.model->table)) {
      detect::mark_boundary(result.prepared, result.found, &progress);
    }
    warn_of_rounding(file, cloud.position_type, result.prepared, classifier.model->descriptor.range,
                     [&] { return result.found.s_min; });
  } else {
    result.found = classify_by_method(cloud, classifier.method, &progress);
  }
  if (!result.found.note.empty()) warn(fmt::format("{}: {}", file.string(), result.found.note));
  return result;
}

}  // namespace pcednet::app
