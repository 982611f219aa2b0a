#pragma once

#include <cstddef>
#include <deque>
#include <filesystem>
#include <functional>
#include <optional>
#include <set>
#include <vector>

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

}  // namespace pcednet::app
