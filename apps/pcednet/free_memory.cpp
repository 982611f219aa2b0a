#include "free_memory.h"

#include <sys/resource.h>
#include <unistd.h>

#include <algorithm>
#include <filesystem>
#include <fstream>
#include <limits>
#include <string>

namespace pcednet::app {
namespace {

namespace fs = std::filesystem;

constexpr std::uint64_t kUnlimited = std::numeric_limits<std::uint64_t>::max();

/// The first number in a file; kUnlimited if the file is missing or says max.
std::uint64_t number_in(const fs::path& file) {
  std::uint64_t number = 0;
  return std::ifstream(file) >> number ? number : kUnlimited;
}

std::uint64_t available_on_machine() {
  std::ifstream lines("/proc/meminfo");
  for (std::string name; lines >> name;) {
    std::uint64_t kibibytes = 0;
    if (name == "MemAvailable:" && lines >> kibibytes) return 1024 * kibibytes;
    lines.ignore(std::numeric_limits<std::streamsize>::max(), '\n');
  }
  return kUnlimited;
}

/// The memory left by the groups from `group` up to the root. The page cache counts as used there,
/// but can be reclaimed.
std::uint64_t left_in_groups(const fs::path& root, fs::path group, const char* limit,
                             const char* used) {
  std::uint64_t least = kUnlimited;
  for (;; group = group.parent_path()) {
    const fs::path folder = root / group.relative_path();
    const std::uint64_t most = number_in(folder / limit), now = number_in(folder / used);
    if (most != kUnlimited && now != kUnlimited) {
      std::uint64_t files = 0, kept = 0;
      std::ifstream lines(folder / "memory.stat");
      for (std::string name; lines >> name >> files;) {
        if (name == "inactive_file" || name == "total_inactive_file") kept = files;
      }
      const std::uint64_t taken = now - std::min(now, kept);
      least = std::min(least, most - std::min(most, taken));
    }
    if (!group.has_relative_path()) return least;
  }
}

/// For both versions of control groups.
std::uint64_t left_by_groups() {
  std::uint64_t least = kUnlimited;
  std::ifstream lines("/proc/self/cgroup");
  for (std::string line; std::getline(lines, line);) {  // number:controllers:/path
    const std::size_t first = line.find(':'), second = line.find(':', first + 1);
    if (second == std::string::npos) continue;
    const std::string controllers = line.substr(first + 1, second - first - 1);
    const fs::path group = line.substr(second + 1);
    if (controllers.empty()) {
      least =
          std::min(least, left_in_groups("/sys/fs/cgroup", group, "memory.max", "memory.current"));
    } else if (controllers.find("memory") != std::string::npos) {
      least = std::min(least, left_in_groups("/sys/fs/cgroup/memory", group,
                                             "memory.limit_in_bytes", "memory.usage_in_bytes"));
    }
  }
  return least;
}

/// What ulimit -v leaves.
std::uint64_t left_in_address_space() {
  rlimit limit = {};
  if (getrlimit(RLIMIT_AS, &limit) != 0 || limit.rlim_cur == RLIM_INFINITY) return kUnlimited;
  const auto most = static_cast<std::uint64_t>(limit.rlim_cur);
  const std::uint64_t pages = number_in("/proc/self/statm");
  if (pages == kUnlimited) return most;
  return most - std::min(most, pages * static_cast<std::uint64_t>(sysconf(_SC_PAGESIZE)));
}

}  // namespace

std::uint64_t free_memory() {
  return std::min({available_on_machine(), left_by_groups(), left_in_address_space()});
}

}  // namespace pcednet::app
