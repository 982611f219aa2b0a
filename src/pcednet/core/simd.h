#pragma once

#include <cstdint>

#if defined(__x86_64__)
#include <immintrin.h>  // its functions are always inlined
#endif

/// Vectors of W floats for the vector code of a room, which is one set of headers, templates on W,
/// compiled by one unit per InstructionSet (processor.h) with the flags of its own.
///
/// The linker must never merge a function of one such unit with that of another unit: the processor
/// may lack the instructions, and gls lets the compiler contract a*b+c where nothing else does. So
/// every function here is always inlined, the headers that use them keep their functions in unnamed
/// namespaces, and neither calls a function of the standard library outside constant expressions.
namespace pcednet {

template <int W>
struct VectorTypes {
  typedef float Floats __attribute__((vector_size(W * sizeof(float))));
  typedef std::uint32_t Words __attribute__((vector_size(W * sizeof(float))));
};

template <int W>
using Floats = typename VectorTypes<W>::Floats;

/// The bits of as many floats.
template <int W>
using Words = typename VectorTypes<W>::Words;

/// The floats of a vector type V.
template <typename V>
inline constexpr int kWidthOf = sizeof(V) / sizeof(float);

/// W floats from any address.
template <int W>
[[gnu::always_inline]] inline Floats<W> load(const float* from) {
  Floats<W> v;
  __builtin_memcpy(&v, from, sizeof v);
  return v;
}

template <typename V>
[[gnu::always_inline]] inline void store(float* to, V v) {
  __builtin_memcpy(to, &v, sizeof v);
}

template <int W>
[[gnu::always_inline]] inline Floats<W> splat(float value) {
  return Floats<W>{} + value;
}

/// v where it is above `low`, and `low` elsewhere and for NaN. The compilers need the instruction
/// by name, and GCC 12 its masked form: the header's plain one warns of an uninitialised value.
template <typename V>
[[gnu::always_inline]] inline V at_least(V v, float low) {
  const V limit = splat<kWidthOf<V>>(low);
#if defined(__AVX512F__)
  if constexpr (kWidthOf<V> == 16) return (V)_mm512_maskz_max_ps(0xFFFF, (__m512)v, (__m512)limit);
#endif
#if defined(__AVX__)
  if constexpr (kWidthOf<V> == 8) return (V)_mm256_max_ps((__m256)v, (__m256)limit);
#endif
#if defined(__x86_64__)
  if constexpr (kWidthOf<V> == 4) return (V)_mm_max_ps((__m128)v, (__m128)limit);
#endif
  return v > limit ? v : limit;
}

/// v where it is below `high`, and `high` elsewhere and for NaN.
template <typename V>
[[gnu::always_inline]] inline V at_most(V v, float high) {
  const V limit = splat<kWidthOf<V>>(high);
#if defined(__AVX512F__)
  if constexpr (kWidthOf<V> == 16) return (V)_mm512_maskz_min_ps(0xFFFF, (__m512)v, (__m512)limit);
#endif
#if defined(__AVX__)
  if constexpr (kWidthOf<V> == 8) return (V)_mm256_min_ps((__m256)v, (__m256)limit);
#endif
#if defined(__x86_64__)
  if constexpr (kWidthOf<V> == 4) return (V)_mm_min_ps((__m128)v, (__m128)limit);
#endif
  return v < limit ? v : limit;
}

template <typename V>
[[gnu::always_inline]] inline V positive_part(V v) {
  return at_least(v, 0.0f);
}

template <typename V>
[[gnu::always_inline]] inline V absolute(V v) {
  return (V)((Words<kWidthOf<V>>)v & 0x7FFFFFFFu);
}

/// One instruction where the unit is compiled with -fno-math-errno.
template <typename V>
[[gnu::always_inline]] inline V square_root(V v) {
  for (int i = 0; i < kWidthOf<V>; ++i) v[i] = __builtin_sqrtf(v[i]);
  return v;
}

/// Bit i is set where a[i] < b[i].
template <typename V>
[[gnu::always_inline]] inline unsigned bits_below(V a, V b) {
#if defined(__AVX512F__)
  if constexpr (kWidthOf<V> == 16) return _mm512_cmp_ps_mask((__m512)a, (__m512)b, _CMP_LT_OQ);
#endif
  const auto below = a < b;
#if defined(__AVX__)
  if constexpr (kWidthOf<V> == 8) return static_cast<unsigned>(_mm256_movemask_ps((__m256)below));
#endif
#if defined(__x86_64__)
  if constexpr (kWidthOf<V> == 4) return static_cast<unsigned>(_mm_movemask_ps((__m128)below));
#endif
  unsigned bits = 0;
  for (int i = 0; i < kWidthOf<V>; ++i) bits |= static_cast<unsigned>(below[i] & 1) << i;
  return bits;
}

template <typename V>
[[gnu::always_inline]] inline bool any_positive(V v) {
  return bits_below(V{}, v) != 0;
}

/// The sum of the lanes, for every width in the order of the halves: they are added until four
/// lanes are left.
template <typename V>
[[gnu::always_inline]] inline float sum_of_lanes(V v) {
  if constexpr (kWidthOf<V> == 4) {
    return (v[0] + v[2]) + (v[1] + v[3]);
  } else {
    Floats<kWidthOf<V> / 2> halves[2];
    static_assert(sizeof halves == sizeof v);
    __builtin_memcpy(halves, &v, sizeof v);
    return sum_of_lanes(halves[0] + halves[1]);
  }
}

}  // namespace pcednet
