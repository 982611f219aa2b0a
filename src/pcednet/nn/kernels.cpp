#include "pcednet/nn/kernels.h"

#include "pcednet/core/error.h"

namespace pcednet::nn {

const Kernels& kernels(InstructionSet instructions) {
  if (instructions > instruction_set()) {
    throw Error(ErrorKind::kFailure, "this processor lacks the requested vector instructions");
  }
#if defined(__x86_64__)
  if (instructions == InstructionSet::kAvx512) return kernels_avx512;
  if (instructions == InstructionSet::kAvx2) return kernels_avx2;
#endif
  return kernels_baseline;
}

}  // namespace pcednet::nn
