#include "pcednet/gls/engine/lane_code.h"

namespace pcednet::gls {

constinit const LaneKernels lane_kernels_avx512 = lane_code<16>("avx512");

}  // namespace pcednet::gls
