#include "prepare.h"

#include <fmt/format.h>

#include "batch.h"
#include "common.h"
#include "pcednet/cloud/bounding_box.h"
#include "pcednet/detect/rounding.h"
#include "pcednet/formats/cloud_facts.h"

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

}  // namespace pcednet::app
