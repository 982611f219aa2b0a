#pragma once

#include <limits>

#include "pcednet/core/simd.h"
#include "pcednet/nn/kernels.h"

/// From samples to the input rows of a table: see kernels.h.
namespace pcednet::nn {
namespace {  // each unit has its own copy, see simd.h

inline void transpose(const float* const* rows, int inputs, float* table, int lanes, int points) {
  for (int p = 0; p < points; p += 4) {
    const float* const* in = rows + p;
    float* out = table + p;
    int u = 0;
    for (; u + 4 <= inputs; u += 4) {
      const Floats<4> a = load<4>(in[0] + u);
      const Floats<4> b = load<4>(in[1] + u);
      const Floats<4> c = load<4>(in[2] + u);
      const Floats<4> d = load<4>(in[3] + u);
      const Floats<4> ab0 = __builtin_shufflevector(a, b, 0, 4, 1, 5);
      const Floats<4> cd0 = __builtin_shufflevector(c, d, 0, 4, 1, 5);
      const Floats<4> ab1 = __builtin_shufflevector(a, b, 2, 6, 3, 7);
      const Floats<4> cd1 = __builtin_shufflevector(c, d, 2, 6, 3, 7);
      float* to = out + static_cast<std::ptrdiff_t>(u) * lanes;
      store(to, __builtin_shufflevector(ab0, cd0, 0, 1, 4, 5));
      store(to + lanes, __builtin_shufflevector(ab0, cd0, 2, 3, 6, 7));
      store(to + 2 * lanes, __builtin_shufflevector(ab1, cd1, 0, 1, 4, 5));
      store(to + 3 * lanes, __builtin_shufflevector(ab1, cd1, 2, 3, 6, 7));
    }
    for (; u < inputs; ++u) {
      for (int k = 0; k < 4; ++k) out[static_cast<std::ptrdiff_t>(u) * lanes + k] = in[k][u];
    }
  }
}

template <int W>
void scale(const InputScaling& scaling, int inputs, float* table, int lanes) {
  constexpr float kLimit = std::numeric_limits<float>::max();
  for (int u = 0; u < inputs; ++u) {
    const float mean = scaling.mean[u];
    const float factor = scaling.inverse_deviation[u];
    float* row = table + static_cast<std::ptrdiff_t>(u) * lanes;
    for (int p = 0; p < lanes; p += W) {
      const Floats<W> x = load<W>(row + p);
      const Floats<W> size = x < 0.0f ? -x : x;
      const Floats<W> y = size <= kLimit ? (x - mean) * factor : splat<W>(0.0f);
      store(row + p, at_most(at_least(y, -scaling.bound), scaling.bound) + 0.0f);
    }
  }
}

template <int W>
void mirror(const SignPattern& signs, float* table, int lanes) {
  const int half = lanes / 2;
  for (int u = 0; u < signs.inputs; ++u) {
    float* row = table + static_cast<std::ptrdiff_t>(u) * lanes;
    for (int p = 0; p < half; p += W) {
      const Floats<W> x = load<W>(row + p);
      store(row + half + p, signs.odd[u] ? 0.0f - x : x);
    }
  }
}

template <int W>
void orient(const SignPattern& signs, float* table, int lanes) {
  for (int p = 0; p < lanes; p += W) {
    Floats<W> decider = splat<W>(0.0f);
    for (int u = signs.first; u < signs.inputs; u += signs.step) {
      decider += load<W>(table + static_cast<std::ptrdiff_t>(u) * lanes + p);
    }
    for (int u = 0; u < signs.inputs; ++u) {
      if (!signs.odd[u]) continue;
      const Floats<W> x = load<W>(table + static_cast<std::ptrdiff_t>(u) * lanes + p);
      decider = decider == 0.0f ? x : decider;
    }
    for (int u = 0; u < signs.inputs; ++u) {
      if (!signs.odd[u]) continue;
      float* at = table + static_cast<std::ptrdiff_t>(u) * lanes + p;
      const Floats<W> x = load<W>(at);
      store(at, decider < 0.0f ? 0.0f - x : x);
    }
  }
}

}  // namespace
}  // namespace pcednet::nn
