#pragma once

/// Marks a function of plain loops to be compiled once per instruction set of x86-64; the program
/// picks the best one for the processor when it starts. Elsewhere, and under the sanitizers, which
/// do not support that choice, it is compiled once.
///
/// Sums are never contracted or reordered, so each copy gives the same bytes.
#if defined(__x86_64__) && defined(__gnu_linux__) && defined(__GNUC__) && !defined(__clang__) && \
    !defined(__SANITIZE_ADDRESS__) && !defined(__SANITIZE_THREAD__)
#define PCEDNET_VECTOR_CLONES \
  __attribute__((target_clones("arch=x86-64-v4", "arch=x86-64-v3", "default")))
#else
#define PCEDNET_VECTOR_CLONES
#endif

namespace pcednet {

/// std::max and std::min by value, which compile without a branch in such loops.
[[gnu::always_inline]] inline double larger(double a, double b) {
  return a < b ? b : a;
}
[[gnu::always_inline]] inline double smaller(double a, double b) {
  return a < b ? a : b;
}

}  // namespace pcednet
