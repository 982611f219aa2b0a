#define PCEDNET_KERNELS lane_kernels_avx2
#define PCEDNET_KERNELS_NAME "avx2"
#define PCEDNET_WIDTH 8
#include "pcednet/gls/lane_kernels.inc"
