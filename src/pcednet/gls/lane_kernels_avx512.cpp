#define PCEDNET_KERNELS lane_kernels_avx512
#define PCEDNET_KERNELS_NAME "avx512"
#define PCEDNET_WIDTH 16
#include "pcednet/gls/lane_kernels.inc"
