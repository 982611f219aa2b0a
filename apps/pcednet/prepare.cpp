#include "prepare.h"

#include "batch.h"
#include "common.h"

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

}  // namespace pcednet::app
