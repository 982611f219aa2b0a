#include "view_options.h"

#include <fmt/format.h>

#include <cmath>
#include <filesystem>
#include <vector>

#include "number_options.h"
#include "pcednet/core/error.h"
#include "pcednet/io/scanners.h"
#include "pcednet/io/text_scan.h"
#include "workbench/render/preview.h"

namespace pcednet::app {

void add_viewpoint_option(CLI::App& command, std::vector<double>& viewpoint,
                          const std::string& help) {
  command.add_option("--viewpoint", viewpoint, help)
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

void add_preview_options(CLI::App& command, PreviewArguments& arguments, const std::string& help) {
  const auto is_png = [](const std::string& path) {
    const std::filesystem::path name = path;
    return io::extension_of(name) == ".png"
               ? ""
               : path + " does not end in .png, the one format of previews";
  };
  CLI::Option* preview = command.add_option("--preview", arguments.path, help)->check(is_png);
  command
      .add_option_function<std::vector<double>>(
          "--preview-from",
          [&arguments](const std::vector<double>& from) {
            const double azimuth = from[0], elevation = from[1];
            if (!std::isfinite(azimuth) || !(std::abs(elevation) <= 90.0)) {
              throw CLI::ValidationError("--preview-from",
                                         "wants two angles in degrees, the second from -90 to 90");
            }
            arguments.direction = render::direction_from(azimuth, elevation);
          },
          "Look from here (AZIMUTH ELEVATION): degrees from the x axis towards the y axis, and "
          "degrees above the horizon (default: from where most edges are seen)")
      ->expected(2)
      ->needs(preview);
}

}  // namespace pcednet::app
