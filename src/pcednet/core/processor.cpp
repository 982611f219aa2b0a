#include "pcednet/core/processor.h"

#include <cstddef>

namespace pcednet {
namespace {

InstructionSet detect() {
#if defined(__x86_64__)
  // Instruction by instruction, since older compilers do not know the levels by name; what else
  // belongs to a level every such processor has.
  const bool avx2 = __builtin_cpu_supports("avx2") && __builtin_cpu_supports("fma") &&
                    __builtin_cpu_supports("bmi") && __builtin_cpu_supports("bmi2");
  const bool avx512 = __builtin_cpu_supports("avx512f") && __builtin_cpu_supports("avx512bw") &&
                      __builtin_cpu_supports("avx512cd") && __builtin_cpu_supports("avx512dq") &&
                      __builtin_cpu_supports("avx512vl");
  if (avx2 && avx512) return InstructionSet::kAvx512;
  if (avx2) return InstructionSet::kAvx2;
#endif
  return InstructionSet::kBaseline;
}

}  // namespace

InstructionSet instruction_set() {
  static const InstructionSet widest = detect();
  return widest;
}

std::span<const InstructionSet> usable_instruction_sets() {
  static constexpr InstructionSet kAll[] = {InstructionSet::kBaseline, InstructionSet::kAvx2,
                                            InstructionSet::kAvx512};
  return std::span(kAll).first(static_cast<std::size_t>(instruction_set()) + 1);
}

}  // namespace pcednet
