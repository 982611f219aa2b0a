#pragma once

#include <optional>
#include <string>

#include "common.h"
#include "pcednet/core/vec3.h"

namespace pcednet::app {

struct PreviewArguments {
  std::string path;               ///< of the PNG file; empty: no preview
  std::optional<Vec3> direction;  ///< from the eye into the scene; absent: chosen
};

/// Adds --preview, with this help, and --preview-from. `arguments` must outlive the parsing.
void add_preview_options(CLI::App& command, PreviewArguments& arguments, const std::string& help);

}  // namespace pcednet::app
