#include "viewpoint.h"

#include <fmt/format.h>

#include <CLI/CLI.hpp>

#include "number_options.h"
#include "pcednet/core/error.h"
#include "pcednet/io/scanners.h"

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
  if (io::has_several_scans(cloud)) {
    throw Error(ErrorKind::kUsage,
                fmt::format("{}: is of several scans, --viewpoint is for one", file.string()));
  }
  io::set_scanners({*place_in(viewpoint)}, cloud);
}

std::optional<Vec3> place_in(const std::vector<double>& viewpoint) {
  if (viewpoint.empty()) return std::nullopt;
  return Vec3(viewpoint.at(0), viewpoint.at(1), viewpoint.at(2));
}

}  // namespace pcednet::app
