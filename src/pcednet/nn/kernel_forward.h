#pragma once

#include "pcednet/core/simd.h"
#include "pcednet/nn/kernels.h"
#include "pcednet/nn/plan.h"

/// Affine maps: see kernels.h.
namespace pcednet::nn {
namespace {  // each unit has its own copy, see simd.h

/// Outputs o to o + R of a map.
template <int W, int R>
[[gnu::always_inline]] inline void forward_tile(const AffineMap& map, int o,
                                                const float* parameters, float* table, int lanes) {
  const float* biases = parameters + map.bias + o;
  const float* weights =
      parameters + map.weight + static_cast<std::size_t>(o) * map.weight_output_stride;
  for (int p = 0; p < lanes; p += 2 * W) {
    Floats<W> sums[R][2];
#pragma GCC unroll 8
    for (int r = 0; r < R; ++r) sums[r][0] = sums[r][1] = splat<W>(biases[r]);
    for (int s = 0; s < map.segments; ++s) {
      const float* w = weights + static_cast<std::size_t>(s) * map.weight_segment_stride;
      const float* in =
          table + static_cast<std::ptrdiff_t>(map.in_row + s * map.in_segment_rows) * lanes + p;
      for (int k = 0; k < map.length; ++k, in += lanes) {
        const Floats<W> x0 = load<W>(in);
        const Floats<W> x1 = load<W>(in + W);
#pragma GCC unroll 8
        for (int r = 0; r < R; ++r) {
          const float weight = w[static_cast<std::size_t>(r) * map.weight_output_stride +
                                 static_cast<std::size_t>(k)];
          sums[r][0] += weight * x0;
          sums[r][1] += weight * x1;
        }
      }
    }
#pragma GCC unroll 8
    for (int r = 0; r < R; ++r) {
      float* out = table +
                   static_cast<std::ptrdiff_t>(map.out_row + (o + r) * map.out_row_stride) * lanes +
                   p;
      store(out, sums[r][0]);
      store(out + W, sums[r][1]);
    }
  }
}

template <int W>
void forward(const AffineMap& map, const float* parameters, float* table, int lanes) {
  int o = 0;
  for (; o + 6 <= map.outputs; o += 6) forward_tile<W, 6>(map, o, parameters, table, lanes);
  if (o + 4 <= map.outputs) forward_tile<W, 4>(map, o, parameters, table, lanes), o += 4;
  if (o + 2 <= map.outputs) forward_tile<W, 2>(map, o, parameters, table, lanes), o += 2;
  if (o < map.outputs) forward_tile<W, 1>(map, o, parameters, table, lanes);
}

/// Outputs o to o + R of a map from inputs whose second half mirrors the first.
template <int W, int R>
[[gnu::always_inline]] inline void mirrored_tile(const AffineMap& map, int o,
                                                 const SignPattern& signs, const float* parameters,
                                                 float* table, int lanes) {
  const int half = lanes / 2;
  const float* biases = parameters + map.bias + o;
  const float* weights =
      parameters + map.weight + static_cast<std::size_t>(o) * map.weight_output_stride;
  for (int p = 0; p < half; p += W) {
    Floats<W> sums[R][2];
#pragma GCC unroll 8
    for (int r = 0; r < R; ++r) sums[r][0] = sums[r][1] = splat<W>(biases[r]);
    for (int s = 0; s < map.segments; ++s) {
      const float* w = weights + static_cast<std::size_t>(s) * map.weight_segment_stride;
      const int row = map.in_row + s * map.in_segment_rows;
      for (int k = 0; k < map.length; ++k) {
        const Floats<W> x = load<W>(table + static_cast<std::ptrdiff_t>(row + k) * lanes + p);
        Floats<W> products[R];
#pragma GCC unroll 8
        for (int r = 0; r < R; ++r) {
          products[r] = w[static_cast<std::size_t>(r) * map.weight_output_stride +
                          static_cast<std::size_t>(k)] *
                        x;
          sums[r][0] += products[r];
        }
        if (signs.odd[row + k]) {
#pragma GCC unroll 8
          for (int r = 0; r < R; ++r) sums[r][1] -= products[r];
        } else {
#pragma GCC unroll 8
          for (int r = 0; r < R; ++r) sums[r][1] += products[r];
        }
      }
    }
#pragma GCC unroll 8
    for (int r = 0; r < R; ++r) {
      float* out = table +
                   static_cast<std::ptrdiff_t>(map.out_row + (o + r) * map.out_row_stride) * lanes +
                   p;
      store(out, sums[r][0]);
      store(out + half, sums[r][1]);
    }
  }
}

template <int W>
void forward_mirrored(const AffineMap& map, const SignPattern& signs, const float* parameters,
                      float* table, int lanes) {
  int o = 0;
  for (; o + 6 <= map.outputs; o += 6) mirrored_tile<W, 6>(map, o, signs, parameters, table, lanes);
  if (o + 4 <= map.outputs) mirrored_tile<W, 4>(map, o, signs, parameters, table, lanes), o += 4;
  if (o + 2 <= map.outputs) mirrored_tile<W, 2>(map, o, signs, parameters, table, lanes), o += 2;
  if (o < map.outputs) mirrored_tile<W, 1>(map, o, signs, parameters, table, lanes);
}

}  // namespace
}  // namespace pcednet::nn
