#pragma once

#include <cstddef>
#include <deque>
#include <filesystem>
#include <functional>
#include <optional>
#include <set>
#include <vector>

#include "pcednet/core/progress.h"
#include "pcednet/tiles/plan.h"

namespace pcednet::app {

/// The tiles of a run, in turn. Each is marked by a file beside its place while it is at work, and
/// tiles that another run has marked come last, so that runs side by side share the work. A mark
/// that a killed run left does no more than that.
class TileQueue {
 public:
  /// `is_done` is asked when the turn of a tile comes and it is marked: true leaves it out. The
  /// plan must outlive the queue.
  TileQueue(const tiles::Plan& plan, const std::vector<std::size_t>& ids,
            std::function<bool(std::size_t tile)> is_done);
  TileQueue(const TileQueue&) = delete;
  TileQueue& operator=(const TileQueue&) = delete;
  ~TileQueue();

  /// The next tile, which the caller runs; none at the end.
  std::optional<std::size_t> next();

  /// Takes off the mark of a tile that is done.
  void finish(std::size_t tile);

  /// The tiles that next() has not seen to.
  std::size_t left() const { return fresh_.size() + busy_.size(); }

 private:
  std::filesystem::path mark_of(std::size_t tile) const;
  bool mark(std::size_t tile);

  const tiles::Plan& plan_;
  std::function<bool(std::size_t)> is_done_;
  std::deque<std::size_t> fresh_, busy_ = {};
  std::set<std::size_t> marked_ = {};  ///< by this run
};

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
