#pragma once

#include <filesystem>

#include "pcednet/core/output_file.h"
#include "pcednet/core/progress.h"
#include "pcednet/tiles/plan.h"

namespace pcednet::tiles {

inline constexpr const char* kNumberColumn = "pcednet_number";

/// Copies of the inputs whose points are in order in space.
struct SortRequest {
  std::filesystem::path folder = {};     ///< for the copies; empty: none are made
  bool if_needed = false;                ///< only for inputs that would otherwise be rejected
  bool numbered = false;                 ///< each point with its number: see kNumberColumn
  Overwrite overwrite = Overwrite::kNo;  ///< replace files with the names of copies
};

/// Replaces the inputs of a plan by copies in the folder: a file for each tile, its points along a
/// space-filling curve, so that a tile needs to read little more than its own. Columns and
/// coordinates stay unchanged. Takes the disk space of all points uncompressed, temporarily twice,
/// and the memory of one tile. Throws Error(kUsage) before any work if a copy would replace an
/// input or, without Overwrite::kYes, another file.
///
/// If `numbered`, the copies have a further column, kNumberColumn: the number of each point,
/// counted through all inputs.
void sort_inputs(const SortRequest& request, Plan& plan, const Progress* progress);

}  // namespace pcednet::tiles
