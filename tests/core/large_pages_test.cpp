#include "pcednet/core/large_pages.h"

#include <gtest/gtest.h>

#include <cstdint>
#include <filesystem>
#include <fstream>
#include <sstream>
#include <string>
#include <vector>

#include "pcednet/core/unset_array.h"

namespace pcednet {
namespace {

/// The flags of the mapping that holds an address, from /proc/self/smaps.
std::string flags_at(const void* address) {
  const auto wanted = reinterpret_cast<std::uintptr_t>(address);
  std::ifstream lines("/proc/self/smaps");
  bool is_here = false;
  for (std::string line; std::getline(lines, line);) {
    std::uintptr_t begin = 0, end = 0;
    char dash = 0;
    std::istringstream words(line);
    if (words >> std::hex >> begin >> dash >> end && dash == '-') {
      is_here = begin <= wanted && wanted < end;
    }
    if (is_here && line.starts_with("VmFlags:")) return line + ' ';
  }
  return {};
}

TEST(LargePages, AreAskedForInLargeArraysAlone) {
  if (!std::filesystem::exists("/sys/kernel/mm/transparent_hugepage/enabled")) {
    GTEST_SKIP() << "this system has no large pages";
  }
  const UnsetArray<std::uint64_t> large(8 << 20);  // 64 MiB, which malloc() maps by themselves
  EXPECT_NE(flags_at(&large[large.size() / 2]).find(" hg "), std::string::npos);
  const UnsetArray<std::uint64_t> small(1 << 17);
  EXPECT_EQ(flags_at(small.data()).find(" hg "), std::string::npos);
}

TEST(LargePages, KeepWhatMemoryHolds) {
  std::vector<std::uint32_t> numbers(5'000'000);
  for (std::size_t i = 0; i < numbers.size(); ++i) numbers[i] = static_cast<std::uint32_t>(i);
  prefer_large_pages(numbers.data(), numbers.size() * sizeof numbers[0]);
  prefer_large_pages(nullptr, 0);
  for (std::size_t i = 0; i < numbers.size(); ++i) ASSERT_EQ(numbers[i], i);
}

}  // namespace
}  // namespace pcednet
