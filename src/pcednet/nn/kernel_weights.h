#pragma once

#include "pcednet/nn/kernel_math.h"
#include "pcednet/nn/kernels.h"
#include "pcednet/nn/plan.h"

/// Derivatives by the parameters of affine maps: see kernels.h.
namespace pcednet::nn {
namespace {  // each unit has its own copy, see simd.h

/// Adds to `gradient` the derivatives by the weights of R outputs and C inputs. Sixteen sums per
/// weight, of every sixteenth lane each, whatever the vectors' width.
template <int W, int R, int C>
[[gnu::always_inline]] inline void weight_tile(const float* deltas, std::ptrdiff_t delta_stride,
                                               const float* in, int lanes, float* gradient,
                                               std::size_t gradient_stride) {
  float partial[R * C][16];
  for (int q = 0; q < 16; q += W) {
    Floats<W> sums[R][C];
#pragma GCC unroll 8
    for (int r = 0; r < R; ++r) {
#pragma GCC unroll 8
      for (int c = 0; c < C; ++c) sums[r][c] = splat<W>(0.0f);
    }
    for (int p = q; p < lanes; p += 16) {
      Floats<W> x[C];
#pragma GCC unroll 8
      for (int c = 0; c < C; ++c) x[c] = load<W>(in + static_cast<std::ptrdiff_t>(c) * lanes + p);
#pragma GCC unroll 8
      for (int r = 0; r < R; ++r) {
        const Floats<W> delta = load<W>(deltas + r * delta_stride + p);
#pragma GCC unroll 8
        for (int c = 0; c < C; ++c) sums[r][c] += delta * x[c];
      }
    }
#pragma GCC unroll 8
    for (int r = 0; r < R; ++r) {
#pragma GCC unroll 8
      for (int c = 0; c < C; ++c) store(partial[r * C + c] + q, sums[r][c]);
    }
  }
  for (int r = 0; r < R; ++r, gradient += gradient_stride) {
    if constexpr (C == 4) {
      store(gradient, load<4>(gradient) + four_sums16(partial + 4 * r));
    } else {
      for (int c = 0; c < C; ++c) gradient[c] += sum16(partial[r * C + c]);
    }
  }
}

/// The weights of R outputs of one segment.
template <int W, int R>
[[gnu::always_inline]] inline void weight_rows(const float* deltas, std::ptrdiff_t delta_stride,
                                               const float* in, int length, int lanes,
                                               float* gradient, std::size_t stride) {
  int k = 0;
  for (; k + 4 <= length; k += 4) {
    weight_tile<W, R, 4>(deltas, delta_stride, in + static_cast<std::ptrdiff_t>(k) * lanes, lanes,
                         gradient + k, stride);
  }
  for (; k < length; ++k) {
    weight_tile<W, R, 1>(deltas, delta_stride, in + static_cast<std::ptrdiff_t>(k) * lanes, lanes,
                         gradient + k, stride);
  }
}

template <int W>
[[gnu::always_inline]] inline void weight_gradient(const AffineMap& map, const float* table,
                                                   const float* deltas, int lanes,
                                                   float* gradient) {
  const std::ptrdiff_t delta_stride = static_cast<std::ptrdiff_t>(map.out_row_stride) * lanes;
  for (int s = 0; s < map.segments; ++s) {
    const float* in =
        table + static_cast<std::ptrdiff_t>(map.in_row + s * map.in_segment_rows) * lanes;
    for (int o = 0; o < map.outputs;) {
      const float* d = deltas + map.out_row * static_cast<std::ptrdiff_t>(lanes) + o * delta_stride;
      float* g = gradient + map.weight + static_cast<std::size_t>(o) * map.weight_output_stride +
                 static_cast<std::size_t>(s) * map.weight_segment_stride;
      if (o + 3 <= map.outputs) {
        weight_rows<W, 3>(d, delta_stride, in, map.length, lanes, g, map.weight_output_stride);
        o += 3;
      } else {
        weight_rows<W, 1>(d, delta_stride, in, map.length, lanes, g, map.weight_output_stride);
        o += 1;
      }
    }
  }
  for (int o = 0; o < map.outputs; ++o) {
    const float* d = deltas + map.out_row * static_cast<std::ptrdiff_t>(lanes) + o * delta_stride;
    float partial[16];
    for (int q = 0; q < 16; q += W) {
      Floats<W> sum = splat<W>(0.0f);
      for (int p = q; p < lanes; p += 16) sum += load<W>(d + p);
      store(partial + q, sum);
    }
    gradient[map.bias + static_cast<std::size_t>(o)] += sum16(partial);
  }
}

}  // namespace
}  // namespace pcednet::nn
