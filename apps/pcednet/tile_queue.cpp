#include "tile_queue.h"

#include <fcntl.h>
#include <unistd.h>

#include <cerrno>
#include <system_error>
#include <utility>

namespace pcednet::app {

namespace fs = std::filesystem;

TileQueue::TileQueue(const tiles::Plan& plan, const std::vector<std::size_t>& ids,
                     std::function<bool(std::size_t tile)> is_done)
    : plan_(plan), is_done_(std::move(is_done)), fresh_(ids.begin(), ids.end()) {}

TileQueue::~TileQueue() {
  while (!marked_.empty()) finish(*marked_.begin());
}

std::optional<std::size_t> TileQueue::next() {
  while (left() > 0) {
    const bool is_fresh = !fresh_.empty();
    std::deque<std::size_t>& from = is_fresh ? fresh_ : busy_;
    const std::size_t tile = from.front();
    from.pop_front();
    if (!mark(tile) && is_fresh) {
      busy_.push_back(tile);
      continue;
    }
    // Asked only now: another run may have done it and taken off its mark meanwhile.
    if (!is_done_(tile)) return tile;
    if (marked_.count(tile) > 0) finish(tile);
  }
  return std::nullopt;
}

void TileQueue::finish(std::size_t tile) {
  marked_.erase(tile);
  std::error_code ignored;
  fs::remove(mark_of(tile), ignored);
}

/// A name of those that may be left behind: see OutputFile.
fs::path TileQueue::mark_of(std::size_t tile) const {
  fs::path mark = plan_.tiles[tile].output;
  return mark += ".part-run";
}

/// False if another run has marked the tile. Where no mark can be made, the tile is run all the
/// same.
bool TileQueue::mark(std::size_t tile) {
  const int file = open(mark_of(tile).c_str(), O_WRONLY | O_CREAT | O_EXCL | O_CLOEXEC, 0666);
  if (file < 0) return errno != EEXIST;
  close(file);
  marked_.insert(tile);
  return true;
}

}  // namespace pcednet::app
