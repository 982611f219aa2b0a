#include "pcednet/nn/kernels.h"

#include <limits>

#if defined(__x86_64__)
#include <immintrin.h>
#endif

#include "pcednet/core/error.h"

namespace pcednet::nn {
namespace {

// Once per level: NN_LEVEL is its namespace, NN_BYTES the size of its vector registers, NN_TARGET
// the function attribute that selects its instructions, NN_MAX and NN_MIN, where there are such,
// its instructions for a > b ? a : b and a < b ? a : b.
#define NN_LEVEL baseline
#define NN_BYTES 16
#define NN_TARGET
#if defined(__x86_64__)
#define NN_MAX _mm_max_ps
#define NN_MIN _mm_min_ps
#endif
#include "pcednet/nn/kernels.inc"
#undef NN_LEVEL
#undef NN_BYTES
#undef NN_TARGET
#undef NN_MAX
#undef NN_MIN

#if defined(__x86_64__)
#define NN_LEVEL avx2
#define NN_BYTES 32
#define NN_TARGET __attribute__((target("arch=x86-64-v3")))
#define NN_MAX _mm256_max_ps
#define NN_MIN _mm256_min_ps
#include "pcednet/nn/kernels.inc"
#undef NN_LEVEL
#undef NN_BYTES
#undef NN_TARGET
#undef NN_MAX
#undef NN_MIN

#define NN_LEVEL avx512
#define NN_BYTES 64
#define NN_TARGET __attribute__((target("arch=x86-64-v4")))
// With a mask of ones: the plain ones of GCC 12 warn of what is uninitialised.
#define NN_MAX(a, b) _mm512_maskz_max_ps(0xFFFF, a, b)
#define NN_MIN(a, b) _mm512_maskz_min_ps(0xFFFF, a, b)
#include "pcednet/nn/kernels.inc"
#undef NN_LEVEL
#undef NN_BYTES
#undef NN_TARGET
#undef NN_MAX
#undef NN_MIN
#endif

}  // namespace

VectorLevel vector_level() {
#if defined(__x86_64__)
  // Instruction by instruction, since older compilers do not know the levels by name; what else
  // belongs to a level every such processor has.
  static const VectorLevel level = [] {
    const bool avx2 = __builtin_cpu_supports("avx2") && __builtin_cpu_supports("fma") &&
                      __builtin_cpu_supports("bmi") && __builtin_cpu_supports("bmi2");
    const bool avx512 = __builtin_cpu_supports("avx512f") && __builtin_cpu_supports("avx512bw") &&
                        __builtin_cpu_supports("avx512cd") && __builtin_cpu_supports("avx512dq") &&
                        __builtin_cpu_supports("avx512vl");
    if (avx2 && avx512) return VectorLevel::kAvx512;
    return avx2 ? VectorLevel::kAvx2 : VectorLevel::kBaseline;
  }();
  return level;
#else
  return VectorLevel::kBaseline;
#endif
}

const Kernels& kernels(VectorLevel level) {
  if (level > vector_level()) {
    throw Error(ErrorKind::kFailure, "this processor lacks the requested vector instructions");
  }
#if defined(__x86_64__)
  if (level == VectorLevel::kAvx512) return avx512::kKernels;
  if (level == VectorLevel::kAvx2) return avx2::kKernels;
#endif
  return baseline::kKernels;
}

}  // namespace pcednet::nn
