#pragma once

#include <CLI/CLI.hpp>
#include <filesystem>

#include "pcednet/cloud/bounding_box.h"
#include "pcednet/detect/train.h"
#include "pcednet/gls/scale_space_options.h"

namespace pcednet::app {

/// Adds --scales, --features, --reconstruction, --gate, --second-gate, --exact, --s-min and
/// --s-max. `options` must outlive the parsing.
void add_descriptor_options(CLI::App& command, gls::ScaleSpaceOptions& options);

/// Adds --gate and --second-gate alone.
void add_gate_options(CLI::App& command, gls::ScaleSpaceOptions& options);

/// Adds --s-min and --s-max alone.
void add_scale_range_options(CLI::App& command, gls::ScaleSpaceOptions& options);

/// Adds --exact alone.
void add_engine_option(CLI::App& command, gls::ScaleSpaceOptions& options);

/// Adds --network, --classes, --width, --symmetry and --context.
void add_network_options(CLI::App& command, detect::TrainOptions& options);

/// Throws Error(kUsage) if the given s_min exceeds the diagonal of the cloud's box; warns if the
/// given s_max does.
void check_scales(const std::filesystem::path& file, const BoundingBox& box,
                  const gls::ScaleSpaceOptions& options);

}  // namespace pcednet::app
