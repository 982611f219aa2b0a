#pragma once

#include <cstddef>
#include <filesystem>
#include <functional>
#include <vector>

#include "pcednet/core/progress.h"

namespace pcednet::app {

struct TileJobs {
  std::filesystem::path plan;
  std::vector<std::size_t> tiles;
  int jobs = 1;     ///< processes at a time
  int threads = 0;  ///< of each
  /// Asked before a tile begins: true leaves it out.
  std::function<bool(std::size_t tile)> is_done;
};

/// Runs every tile as a separate process, several at a time; returns how many. A failure does not
/// stop the others. Throws Error(kCancelled) once all are stopped after a signal, otherwise an
/// Error of the kind of the first failure that names the tiles that failed.
std::size_t run_tile_jobs(const TileJobs& jobs, const Progress& progress);

}  // namespace pcednet::app
