#include "pcednet/gls/lane_kernels.h"

#include <vector>

namespace pcednet::gls {

extern const LaneKernels lane_kernels_baseline;
#ifdef PCEDNET_X86_KERNELS
extern const LaneKernels lane_kernels_avx2;
extern const LaneKernels lane_kernels_avx512;
#endif

std::span<const LaneKernels> all_lane_kernels() {
  static const std::vector<LaneKernels> kernels = [] {
    std::vector<LaneKernels> usable = {lane_kernels_baseline};
#ifdef PCEDNET_X86_KERNELS
    if (__builtin_cpu_supports("avx2") && __builtin_cpu_supports("fma")) {
      usable.push_back(lane_kernels_avx2);
    }
    if (__builtin_cpu_supports("avx512f") && __builtin_cpu_supports("avx512dq") &&
        __builtin_cpu_supports("avx512vl")) {
      usable.push_back(lane_kernels_avx512);
    }
#endif
    return usable;
  }();
  return kernels;
}

const LaneKernels& lane_kernels() {
  return all_lane_kernels().back();
}

}  // namespace pcednet::gls
