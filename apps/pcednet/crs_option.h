#pragma once

#include <CLI/CLI.hpp>
#include <optional>

#include "pcednet/io/coordinate_system.h"

namespace pcednet::app {

/// Adds --crs, which sets `system` to that of a code of EPSG, as io::system_of_code() does.
CLI::Option* add_crs_option(CLI::App& command, std::optional<io::CoordinateSystem>& system);

}  // namespace pcednet::app
