#include "pcednet/gls/engine/lane_code.h"

namespace pcednet::gls {

constinit const LaneKernels lane_kernels_avx2 = lane_code<8>("avx2");

}  // namespace pcednet::gls
