#pragma once

#include "pcednet/nn/kernel_weights.h"
#include "pcednet/nn/plan.h"

/// Derivatives of affine maps: see kernels.h.
namespace pcednet::nn {
namespace {  // each unit has its own copy, see simd.h

/// Derivatives by the inputs k to k + R of segment s.
template <int W, int R>
[[gnu::always_inline]] inline void input_tile(const AffineMap& map, int s, int k,
                                              const float* parameters, float* deltas, int lanes) {
  const float* weights = parameters + map.weight +
                         static_cast<std::size_t>(s) * map.weight_segment_stride +
                         static_cast<std::size_t>(k);
  const std::ptrdiff_t in_row = map.in_row + s * map.in_segment_rows + k;
  const std::ptrdiff_t stride = static_cast<std::ptrdiff_t>(map.out_row_stride) * lanes;
  for (int p = 0; p < lanes; p += 2 * W) {
    float* in = deltas + in_row * lanes + p;
    const float* out = deltas + map.out_row * static_cast<std::ptrdiff_t>(lanes) + p;
    Floats<W> sums[R][2];
#pragma GCC unroll 8
    for (int r = 0; r < R; ++r) {
      sums[r][0] = load<W>(in + static_cast<std::ptrdiff_t>(r) * lanes);
      sums[r][1] = load<W>(in + static_cast<std::ptrdiff_t>(r) * lanes + W);
    }
    for (int o = 0; o < map.outputs; ++o, out += stride) {
      const float* w = weights + static_cast<std::size_t>(o) * map.weight_output_stride;
      const Floats<W> d0 = load<W>(out);
      const Floats<W> d1 = load<W>(out + W);
#pragma GCC unroll 8
      for (int r = 0; r < R; ++r) {
        sums[r][0] += w[r] * d0;
        sums[r][1] += w[r] * d1;
      }
    }
#pragma GCC unroll 8
    for (int r = 0; r < R; ++r) {
      store(in + static_cast<std::ptrdiff_t>(r) * lanes, sums[r][0]);
      store(in + static_cast<std::ptrdiff_t>(r) * lanes + W, sums[r][1]);
    }
  }
}

template <int W>
void backward(const AffineMap& map, const float* parameters, const float* table, float* deltas,
              int lanes, bool to_inputs, float* gradient) {
  weight_gradient<W>(map, table, deltas, lanes, gradient);
  if (!to_inputs) return;
  for (int s = 0; s < map.segments; ++s) {
    int k = 0;
    for (; k + 6 <= map.length; k += 6) input_tile<W, 6>(map, s, k, parameters, deltas, lanes);
    if (k + 4 <= map.length) input_tile<W, 4>(map, s, k, parameters, deltas, lanes), k += 4;
    if (k + 2 <= map.length) input_tile<W, 2>(map, s, k, parameters, deltas, lanes), k += 2;
    if (k < map.length) input_tile<W, 1>(map, s, k, parameters, deltas, lanes);
  }
}

}  // namespace
}  // namespace pcednet::nn
