#include "pcednet/nn/kernel_code.h"

namespace pcednet::nn {

constinit const Kernels kernels_avx512 = kernel_code<16>();

}  // namespace pcednet::nn
