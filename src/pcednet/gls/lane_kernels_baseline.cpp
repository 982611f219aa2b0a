#define PCEDNET_KERNELS lane_kernels_baseline
#define PCEDNET_KERNELS_NAME "baseline"
#define PCEDNET_WIDTH 4
#include "pcednet/gls/lane_kernels.inc"
