#pragma once

#include <span>

namespace pcednet {

/// The instruction sets that vector code is compiled for, each with all that stand before it.
enum class InstructionSet {
  kBaseline,  ///< what every processor of the platform has
  kAvx2,      ///< x86-64-v3
  kAvx512,    ///< x86-64-v4
};

/// The instruction sets of this processor, the baseline first.
std::span<const InstructionSet> usable_instruction_sets();

/// The widest instruction set of this processor.
InstructionSet instruction_set();

}  // namespace pcednet
