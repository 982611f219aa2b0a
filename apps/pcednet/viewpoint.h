#pragma once

#include <filesystem>
#include <optional>
#include <vector>

#include "pcednet/cloud/point_cloud.h"

namespace CLI {
class App;
}

namespace pcednet::app {

/// Adds --viewpoint X Y Z.
void add_viewpoint_option(CLI::App& command, std::vector<double>& viewpoint);

/// Tells the cloud where the scanner stood that saw all its points; nothing for an empty
/// `viewpoint`. Throws Error(kUsage) if the cloud is of several scans.
void set_viewpoint(const std::filesystem::path& file, const std::vector<double>& viewpoint,
                   PointCloud& cloud);

/// Its three numbers, if given.
std::optional<Vec3> place_in(const std::vector<double>& viewpoint);

}  // namespace pcednet::app
