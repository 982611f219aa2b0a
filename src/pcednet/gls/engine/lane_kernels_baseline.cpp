#include "pcednet/gls/engine/lane_code.h"

namespace pcednet::gls {

constinit const LaneKernels lane_kernels_baseline = lane_code<4>("baseline");

}  // namespace pcednet::gls
