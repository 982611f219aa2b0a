#include "tile_jobs.h"

#include <fcntl.h>
#include <fmt/format.h>
#include <spawn.h>
#include <sys/wait.h>
#include <unistd.h>

#include <algorithm>
#include <cerrno>
#include <csignal>
#include <cstring>
#include <map>
#include <string>
#include <system_error>
#include <utility>

#include "common.h"
#include "pcednet/core/error.h"
#include "pcednet/core/stopwatch.h"
#include "pcednet/tiles/join.h"

namespace pcednet::app {
namespace {

pid_t start(const TileJobs& jobs, std::size_t tile) {
  // With --overwrite it runs the tile in any case: is_done() has decided.
  std::vector<std::string> words = {"pcednet",     "tiles",
                                    "run",         jobs.plan,
                                    "--tile",      std::to_string(tile),
                                    "--threads",   std::to_string(jobs.threads),
                                    "--overwrite", "--as-job",
                                    "--progress",  "none"};
  std::vector<char*> arguments;
  for (std::string& word : words) arguments.push_back(word.data());
  arguments.push_back(nullptr);
  pid_t child = 0;
  const int failed =
      posix_spawn(&child, "/proc/self/exe", nullptr, nullptr, arguments.data(), environ);
  if (failed != 0) {
    throw Error(ErrorKind::kFailure,
                fmt::format("cannot start a process: {}", std::strerror(failed)));
  }
  return child;
}

/// Processes at work, each on a tile.
class Running {
 public:
  Running() = default;
  Running(const Running&) = delete;
  Running& operator=(const Running&) = delete;
  ~Running() {
    stop();
    while (!tiles_.empty()) wait();
  }

  std::size_t size() const { return tiles_.size(); }
  void add(pid_t child, std::size_t tile) { tiles_[child] = {tile, Stopwatch()}; }
  void stop() const {
    for (const auto& [child, at_work] : tiles_) kill(child, SIGTERM);
  }

  struct Ended {
    std::size_t tile = 0;
    double seconds = 0.0;
    int code = 0;
  };
  /// The next that ends; none after a signal.
  std::vector<Ended> wait() {
    int status = 0;
    const pid_t child = waitpid(-1, &status, 0);
    const auto found = tiles_.find(child);
    if (found == tiles_.end()) {
      if (child < 0 && errno == ECHILD) tiles_.clear();
      return {};
    }
    const auto& [tile, watch] = found->second;
    const Ended ended = {tile, watch.elapsed(), WIFEXITED(status) ? WEXITSTATUS(status) : 1};
    tiles_.erase(found);
    return {ended};
  }

 private:
  std::map<pid_t, std::pair<std::size_t, Stopwatch>> tiles_ = {};
};

}  // namespace

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

std::size_t run_tile_jobs(const TileJobs& jobs, TileQueue& queue, const Progress& progress) {
  const std::size_t all = queue.left();
  Running running;
  std::vector<std::size_t> failed;
  std::size_t started = 0;
  int code = 0;
  Stage stage(&progress, "tiles", all);
  while (queue.left() > 0 || running.size() > 0) {
    throw_if_cancelled(&progress);
    if (queue.left() > 0 && running.size() < static_cast<std::size_t>(jobs.jobs)) {
      const std::size_t before = queue.left();
      const auto tile = queue.next();
      stage.advance(before - queue.left() - (tile ? 1 : 0));
      if (!tile) continue;
      running.add(start(jobs, *tile), *tile);
      ++started;
      continue;
    }
    for (const auto& [tile, seconds, its_code] : running.wait()) {
      queue.finish(tile);
      if (its_code == 0) jobs.done(tile, seconds);
      stage.advance();
      if (its_code == 0) continue;
      failed.push_back(tile);
      if (code == 0) code = its_code;
    }
  }
  if (failed.empty()) return started;
  std::sort(failed.begin(), failed.end());
  throw Error(static_cast<ErrorKind>(code),
              fmt::format("{} of {} tiles failed, for the reasons above: {}", failed.size(), all,
                          tiles::list_of(failed)));
}

}  // namespace pcednet::app
