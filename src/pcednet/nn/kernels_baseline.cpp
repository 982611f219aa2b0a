#include "pcednet/nn/kernel_code.h"

namespace pcednet::nn {

constinit const Kernels kernels_baseline = kernel_code<4>();

}  // namespace pcednet::nn
