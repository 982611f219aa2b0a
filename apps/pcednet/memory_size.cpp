#include "memory_size.h"

#include <fmt/format.h>
#include <sys/resource.h>
#include <unistd.h>

#include <algorithm>
#include <charconv>
#include <cmath>
#include <filesystem>
#include <fstream>
#include <limits>
#include <string>

#include "pcednet/core/error.h"

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

std::uint64_t byte_size(const std::string& option, const std::string& text) {
  double number = 0.0;
  const char* const end = text.data() + text.size();
  const auto [rest, error] = std::from_chars(text.data(), end, number);
  std::string letters(rest, end);  // 2, 2G, 2GB and 2GiB are all powers of 1024
  for (char& letter : letters) letter = static_cast<char>(letter | 0x20);
  const std::size_t power = letters.empty() ? 0 : std::string("bkmgt").find(letters[0]);
  const std::string after = letters.substr(std::min<std::size_t>(letters.size(), 1));
  const bool is_known = power != std::string::npos &&
                        (after.empty() || (power > 0 && (after == "b" || after == "ib")));
  const double unit = is_known ? std::pow(1024.0, static_cast<double>(power)) : 0.0;
  const double bytes = number * unit;
  if (error == std::errc() && letters.empty() && bytes > 0.0 && bytes < 0x1p20) {
    throw Error(ErrorKind::kUsage,
                fmt::format("{} {}: is a number of bytes: write the unit, such as {}G or {}M",
                            option, text, text, text));
  }
  if (error == std::errc() && bytes >= 1.0 && bytes < 1e18)
    return static_cast<std::uint64_t>(bytes);
  throw Error(ErrorKind::kUsage, fmt::format("{} {}: not a size such as 500M or 2G", option, text));
}

std::string size_text(std::uint64_t bytes) {
  const auto b = static_cast<double>(bytes);
  return b < 0x1p30 ? fmt::format("{:.0f} MiB", std::ceil(b / 0x1p20))
                    : fmt::format("{:.1f} GiB", b / 0x1p30);
}

}  // namespace pcednet::app
