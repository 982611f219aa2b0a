#pragma once

#include <CLI/CLI.hpp>

#include <filesystem>
#include <optional>
#include <string>
#include <vector>

#include "pcednet/cloud/point_cloud.h"
#include "pcednet/core/vec3.h"

namespace pcednet::app {

/// Adds --viewpoint X Y Z.
void add_viewpoint_option(
    CLI::App& command, std::vector<double>& viewpoint,
    const std::string& help =
        "Where the scanner stood (X Y Z) that saw all points, if the file does not tell: estimated "
        "normals face it, and lines has no ends of its shadows");

/// Tells the cloud where the scanner stood that saw all its points; nothing for an empty
/// `viewpoint`. Throws Error(kUsage) if the cloud is of several scans.
void set_viewpoint(const std::filesystem::path& file, const std::vector<double>& viewpoint,
                   PointCloud& cloud);

/// Its three numbers, if given.
std::optional<Vec3> place_in(const std::vector<double>& viewpoint);

struct PreviewArguments {
  std::string path;               ///< of the PNG file; empty: no preview
  std::optional<Vec3> direction;  ///< from the eye into the scene; absent: chosen
};

/// Adds --preview, with this help, and --preview-from. `arguments` must outlive the parsing.
void add_preview_options(CLI::App& command, PreviewArguments& arguments, const std::string& help);

}  // namespace pcednet::app
