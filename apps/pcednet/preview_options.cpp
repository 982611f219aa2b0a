#include "preview_options.h"

#include <cmath>
#include <numbers>
#include <vector>

namespace pcednet::app {
namespace {

/// From an eye in this direction, in degrees, to what it looks at.
Vec3 direction_from(double azimuth, double elevation) {
  constexpr double kRadians = std::numbers::pi / 180.0;
  const double across = std::cos(kRadians * elevation);
  return {-across * std::cos(kRadians * azimuth), -across * std::sin(kRadians * azimuth),
          -std::sin(kRadians * elevation)};
}

}  // namespace

void add_preview_options(CLI::App& command, PreviewArguments& arguments, const std::string& help) {
  CLI::Option* preview = command.add_option("--preview", arguments.path, help);
  command
      .add_option_function<std::vector<double>>(
          "--preview-from",
          [&arguments](const std::vector<double>& from) {
            const double azimuth = from[0], elevation = from[1];
            if (!std::isfinite(azimuth) || !(std::abs(elevation) <= 90.0)) {
              throw CLI::ValidationError("--preview-from",
                                         "wants two angles in degrees, the second from -90 to 90");
            }
            arguments.direction = direction_from(azimuth, elevation);
          },
          "Look from here (AZIMUTH ELEVATION): degrees from the x axis towards the y axis, and "
          "degrees above the horizon (default: from where most edges are seen)")
      ->expected(2)
      ->needs(preview);
}

}  // namespace pcednet::app
