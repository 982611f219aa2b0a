#pragma once

#include "pcednet/nn/kernel_backward.h"
#include "pcednet/nn/kernel_forward.h"
#include "pcednet/nn/kernel_inputs.h"
#include "pcednet/nn/kernel_outputs.h"

namespace pcednet::nn {
namespace {

/// All kernels with W floats per register, for the unit of one instruction set.
template <int W>
constexpr Kernels kernel_code() {
  return {transpose,           scale<W>,    mirror<W>,  orient<W>,        forward<W>,
          forward_mirrored<W>, activate<W>, softmax<W>, cross_entropy<W>, activate_backward<W>,
          backward<W>};
}

}  // namespace
}  // namespace pcednet::nn
