#include "pcednet/core/rank.h"

#include "pcednet/core/vector_clones.h"

namespace pcednet {

PCEDNET_VECTOR_CLONES
void rank(const double* __restrict values, std::size_t count, std::int64_t* __restrict ranks) {
  const std::size_t padded = (count + kRankStep - 1) / kRankStep * kRankStep;
  for (std::size_t i = 0; i < padded; ++i) ranks[i] = 0;
  for (std::size_t j = 0; j < count; ++j) {
    const double value = values[j];
    for (std::size_t i = 0; i < padded; ++i) ranks[i] += value < values[i] ? 1 : 0;
  }
}

}  // namespace pcednet
