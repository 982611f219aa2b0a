#pragma once

#include <cstddef>

namespace pcednet::lines {

/// Sums in four lanes, which have the same bytes on every processor.
typedef double Lanes __attribute__((vector_size(4 * sizeof(double))));
inline constexpr std::size_t kLanes = 4;

[[gnu::always_inline]] inline void load(const double* from, Lanes& lanes) {
  __builtin_memcpy(&lanes, from, sizeof lanes);
}

[[gnu::always_inline]] inline double sum_of(const Lanes& lanes) {
  return (lanes[0] + lanes[2]) + (lanes[1] + lanes[3]);
}

}  // namespace pcednet::lines
