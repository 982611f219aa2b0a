#include "pcednet/gls/engine/lane_kernels.h"

#include <cstddef>

#include "pcednet/core/processor.h"

namespace pcednet::gls {

std::span<const LaneKernels> all_lane_kernels() {
  static const LaneKernels kernels[] = {
    lane_kernels_baseline,
#if defined(__x86_64__)
    lane_kernels_avx2,
    lane_kernels_avx512,
#endif
  };
  return std::span(kernels).first(usable_instruction_sets().size());
}

const LaneKernels& lane_kernels() {
  return all_lane_kernels().back();
}

}  // namespace pcednet::gls
