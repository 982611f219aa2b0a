#pragma once

#include "pcednet/core/simd.h"

/// Functions that libraries compute differently on different processors, and sums whose order does
/// not depend on the width of the vectors.
namespace pcednet::nn {
namespace {  // each unit has its own copy, see simd.h

constexpr float kRounder = 12582912.0f;  // 1.5 * 2^23: adding it rounds to a whole number

/// e^x to 2 ulp (Cephes' polynomial); saturates at e^-86 and e^88, and takes NaN for -86.
template <typename V>
[[gnu::always_inline]] inline V exponential(V x) {
  using Bits = Words<kWidthOf<V>>;
  x = at_most(at_least(x, -86.0f), 88.0f);
  const V shifted = x * 1.44269504f + kRounder;
  const V n = shifted - kRounder;
  const V r = (x - n * 0.693359375f) - n * -2.12194440e-4f;
  V p = r * 1.9875691500e-4f + 1.3981999507e-3f;
  p = p * r + 8.3334519073e-3f;
  p = p * r + 4.1665795894e-2f;
  p = p * r + 1.6666665459e-1f;
  p = p * r + 5.0000001201e-1f;
  p = (p * (r * r) + r) + 1.0f;
  return (V)((Bits)p + ((Bits)shifted << 23));
}

/// Natural logarithm of normal positive numbers to 2 ulp (Cephes' polynomial).
template <typename V>
[[gnu::always_inline]] inline V logarithm(V x) {
  using Bits = Words<kWidthOf<V>>;
  const Bits bits = (Bits)x;
  // m in [sqrt(1/2), sqrt(2)), x = m 2^e
  const Bits offset = bits - 0x3F3504F3u;
  const Bits exponent = (offset >> 23) ^ 0x100u;  // biased by 256, so that it is positive
  const V e = (V)((exponent & 0x1FFu) | 0x4B000000u) - (8388608.0f + 256.0f);
  const V r = (V)((offset & 0x007FFFFFu) + 0x3F3504F3u) - 1.0f;
  V p = r * 7.0376836292e-2f - 1.1514610310e-1f;
  p = p * r + 1.1676998740e-1f;
  p = p * r - 1.2420140846e-1f;
  p = p * r + 1.4249322787e-1f;
  p = p * r - 1.6668057665e-1f;
  p = p * r + 2.0000714765e-1f;
  p = p * r - 2.4999993993e-1f;
  p = p * r + 3.3333331174e-1f;
  const V square = r * r;
  const V tail = (p * r) * square + e * -2.12194440e-4f - 0.5f * square;
  return (r + tail) + e * 0.693359375f;
}

/// 1 + e^-x with a relative error of 3e-7 about zero (a minimax polynomial for 2^f, |f| <= 1/2,
/// whose error is 1e-7); saturates at |x| = 29.8, which a sigmoid in float does not tell from
/// infinity.
template <typename V>
[[gnu::always_inline]] inline V sigmoid_denominator(V x) {
  using Bits = Words<kWidthOf<V>>;
  const V t = at_most(at_least(x * -1.44269504f, -43.0f), 43.0f);
  const V shifted = t + kRounder;
  const V f = t - (shifted - kRounder);
  V p = f * 0x1.5bba14p-10f + 0x1.3cea88p-7f;
  p = p * f + 0x1.c6b752p-5f;
  p = p * f + 0x1.ebf9bcp-3f;
  p = p * f + 0x1.62e42ap-1f;
  p = p * f + 1.0f;
  return 1.0f + (V)((Bits)p + ((Bits)shifted << 23));
}

/// Every fourth of 16 numbers summed, in one order whatever the vectors' width.
[[gnu::always_inline]] inline Floats<4> sum16_by_fours(const float* v) {
  const Floats<4> a = load<4>(v) + load<4>(v + 8);
  const Floats<4> b = load<4>(v + 4) + load<4>(v + 12);
  return a + b;
}

/// The sum of 16 numbers in that order.
[[gnu::always_inline]] inline float sum16(const float* v) {
  return sum_of_lanes(sum16_by_fours(v));
}

/// sum16() of four times 16 numbers.
[[gnu::always_inline]] inline Floats<4> four_sums16(const float (*v)[16]) {
  const Floats<4> a = sum16_by_fours(v[0]), b = sum16_by_fours(v[1]);
  const Floats<4> c = sum16_by_fours(v[2]), d = sum16_by_fours(v[3]);
  const Floats<4> ab02 = __builtin_shufflevector(a, b, 0, 4, 2, 6);
  const Floats<4> ab13 = __builtin_shufflevector(a, b, 1, 5, 3, 7);
  const Floats<4> cd02 = __builtin_shufflevector(c, d, 0, 4, 2, 6);
  const Floats<4> cd13 = __builtin_shufflevector(c, d, 1, 5, 3, 7);
  const Floats<4> even = __builtin_shufflevector(ab02, cd02, 0, 1, 4, 5) +
                         __builtin_shufflevector(ab02, cd02, 2, 3, 6, 7);
  const Floats<4> odd = __builtin_shufflevector(ab13, cd13, 0, 1, 4, 5) +
                        __builtin_shufflevector(ab13, cd13, 2, 3, 6, 7);
  return even + odd;
}

}  // namespace
}  // namespace pcednet::nn
