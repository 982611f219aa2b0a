#pragma once

#include <cstddef>
#include <filesystem>
#include <functional>

#include "pcednet/core/progress.h"
#include "tile_queue.h"

namespace pcednet::app {

struct TileJobs {
  std::filesystem::path plan;
  int jobs = 1;                                                ///< processes at a time
  int threads = 0;                                             ///< of each
  std::function<void(std::size_t tile, double seconds)> done;  ///< called where one succeeded
};

/// Runs every tile of the queue as a separate process, several at a time; returns how many. A
/// failure does not stop the others. Throws Error(kCancelled) once all are stopped after a signal,
/// otherwise an Error of the kind of the first failure that names the tiles that failed.
std::size_t run_tile_jobs(const TileJobs& jobs, TileQueue& queue, const Progress& progress);

}  // namespace pcednet::app
