#include "pcednet/nn/kernel_code.h"

namespace pcednet::nn {

constinit const Kernels kernels_avx2 = kernel_code<8>();

}  // namespace pcednet::nn
