#pragma once

#include <cstddef>
#include <filesystem>
#include <vector>

#include "pcednet/core/progress.h"

namespace pcednet::app {

struct TileJobs {
  std::filesystem::path plan;
  std::vector<std::size_t> tiles;
  int jobs = 1;       ///< processes at a time
  int threads = 0;    ///< of each
  bool redo = false;  ///< tiles that are done, too
};

/// Runs every tile as a separate process, several at a time. A failure does not stop the others.
/// Throws Error(kCancelled) once all are stopped after a signal, otherwise an Error of the kind of
/// the first failure that names the tiles that failed.
void run_tile_jobs(const TileJobs& jobs, const Progress& progress);

}  // namespace pcednet::app
