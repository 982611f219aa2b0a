#include "pcednet/core/processor.h"

#include <gtest/gtest.h>

#include <fstream>
#include <set>
#include <sstream>
#include <string>
#include <vector>

namespace pcednet {
namespace {

TEST(Processor, RunsTheBaselineAndEverySetUpToItsBest) {
  const auto sets = usable_instruction_sets();
  ASSERT_FALSE(sets.empty());
  for (std::size_t i = 0; i < sets.size(); ++i) EXPECT_EQ(static_cast<std::size_t>(sets[i]), i);
  EXPECT_EQ(sets.back(), instruction_set());
}

#if defined(__x86_64__)
TEST(Processor, IsWhatTheSystemSaysItIs) {
  std::ifstream file("/proc/cpuinfo");
  std::string line;
  while (std::getline(file, line) && !line.starts_with("flags")) {
  }
  ASSERT_TRUE(file);
  std::istringstream words(line);
  std::set<std::string> flags;
  for (std::string word; words >> word;) flags.insert(word);
  const auto has = [&](const std::vector<std::string>& names) {
    for (const std::string& name : names) {
      if (!flags.contains(name)) return false;
    }
    return true;
  };
  const bool avx2 = has({"avx2", "fma", "bmi1", "bmi2"});
  const bool avx512 = avx2 && has({"avx512f", "avx512bw", "avx512cd", "avx512dq", "avx512vl"});
  EXPECT_EQ(instruction_set() >= InstructionSet::kAvx2, avx2);
  EXPECT_EQ(instruction_set() >= InstructionSet::kAvx512, avx512);
}
#endif

}  // namespace
}  // namespace pcednet
