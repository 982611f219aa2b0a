#pragma once

#include <filesystem>

#include "pcednet/detect/prepare.h"

namespace CLI {
class App;
}

namespace pcednet::app {

/// Adds --keep-orientation.
void add_prepare_options(CLI::App& command, detect::PrepareOptions& options);

/// detect::prepare(), with its notes as warnings and `file` in its errors.
detect::PreparedCloud prepare(const std::filesystem::path& file, const PointCloud& cloud,
                              const detect::PrepareOptions& options, const Progress& progress);

}  // namespace pcednet::app
