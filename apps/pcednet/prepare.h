#pragma once

#include <filesystem>
#include <functional>

#include "pcednet/detect/prepare.h"
#include "pcednet/gls/scale_space_options.h"

namespace CLI {
class App;
}

namespace pcednet::app {

/// Adds --keep-orientation.
void add_prepare_options(CLI::App& command, detect::PrepareOptions& options);

/// detect::prepare() with its notes as warnings and `file` in its errors.
detect::PreparedCloud prepare(const std::filesystem::path& file, const PointCloud& cloud,
                              const detect::PrepareOptions& options, const Progress& progress);

/// Warns of coordinates of this type that are rounded to more than the spacing, which is
/// `apart()`, found where it matters.
void warn_of_rounding(const std::filesystem::path& file, ScalarType type,
                      const detect::PreparedCloud& cloud, const gls::ScaleRange& range,
                      const std::function<double()>& apart);

}  // namespace pcednet::app
