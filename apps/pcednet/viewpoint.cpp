#include "viewpoint.h"

#include <fmt/format.h>

#include <CLI/CLI.hpp>

#include "common.h"
#include "number_options.h"
#include "pcednet/cloud/attribute.h"
#include "pcednet/core/error.h"

namespace pcednet::app {

void add_viewpoint_option(CLI::App& command, std::vector<double>& viewpoint) {
  command
      .add_option("--viewpoint", viewpoint,
                  "Where the scanner stood (X Y Z) that saw all points, if the file does not tell: "
                  "estimated normals face it, and lines has no ends of its shadows")
      ->expected(3)
      ->check(number("a finite number", [](double) { return true; }));
}

void set_viewpoint(const std::filesystem::path& file, const std::vector<double>& viewpoint,
                   PointCloud& cloud) {
  if (viewpoint.empty()) return;
  if (cloud.scanners.size() > 1 || find_attribute(cloud, "scan")) {
    throw Error(ErrorKind::kUsage,
                fmt::format("{}: is of several scans, --viewpoint is for one", file.string()));
  }
  cloud.scanners = {Vec3(viewpoint[0], viewpoint[1], viewpoint[2])};
  std::erase_if(cloud.comments, [](const auto& one) { return one.starts_with("scanner "); });
  cloud.comments.push_back(
      fmt::format("scanner 0: {} {} {}", viewpoint[0], viewpoint[1], viewpoint[2]));
}

void warn_of_viewpoint_in_tiles(const std::filesystem::path& file,
                                const std::vector<double>& viewpoint) {
  if (viewpoint.empty()) return;
  warn(fmt::format("{}: --viewpoint is not used for clouds that are read in tiles", file.string()));
}

}  // namespace pcednet::app
