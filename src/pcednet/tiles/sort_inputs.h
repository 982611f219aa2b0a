#pragma once

#include <filesystem>

#include "pcednet/core/progress.h"
#include "pcednet/tiles/plan.h"

namespace pcednet::tiles {

inline constexpr const char* kNumberColumn = "pcednet_number";

/// Replaces the inputs of a plan by copies in `folder`: a file for each tile, its points along a
/// space-filling curve, so that a tile needs to read little more than its own. Columns and
/// coordinates stay unchanged. Takes the disk space of all points uncompressed, temporarily twice,
/// and the memory of one tile. Replaces copies of an earlier plan.
///
/// If `numbered`, the copies have a further column, kNumberColumn: the number of each point,
/// counted through all inputs.
void sort_inputs(const std::filesystem::path& folder, bool numbered, Plan& plan,
                 const Progress* progress);

}  // namespace pcednet::tiles
