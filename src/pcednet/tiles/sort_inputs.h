#pragma once

#include <filesystem>

#include "pcednet/core/progress.h"
#include "pcednet/tiles/plan.h"

namespace pcednet::tiles {

inline constexpr const char* kNumberColumn = "pcednet_number";

/// Replaces the inputs of a plan by copies in `folder`: a file for each tile, its points along a
/// space-filling curve, so that a tile need read little more than its own. Columns and coordinates
/// stay as they are. Takes the disk space of all points uncompressed, for a while twice, and the
/// memory of one tile. Replaces copies of an earlier plan.
///
/// If `numbered`, the copies have a further column, kNumberColumn: the number of each point in all
/// inputs, one after the other.
void sort_inputs(const std::filesystem::path& folder, bool numbered, Plan& plan,
                 const Progress* progress);

}  // namespace pcednet::tiles
