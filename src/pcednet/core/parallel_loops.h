#pragma once

#include <cstddef>
#include <numeric>
#include <vector>

#include "pcednet/core/parallel.h"

namespace pcednet {

/// Calls work(i) for every i below `count`, on all threads.
template <typename Work>
void parallel_for_each(std::size_t count, const Work& work) {
  parallel_blocks(count, 1 << 14, [&](std::size_t begin, std::size_t end) {
    for (std::size_t i = begin; i < end; ++i) work(i);
  });
}

/// The number of i below `count` that are `counted`, before each block of parallel_blocks(count,
/// block, ...) and, last, in total: the offsets at which the blocks may write what they keep.
template <typename Counted>
std::vector<std::size_t> counts_before_blocks(std::size_t count, std::size_t block,
                                              const Counted& counted) {
  std::vector<std::size_t> before((count + block - 1) / block + 1);
  parallel_blocks(count, block, [&](std::size_t begin, std::size_t end) {
    std::size_t here = 0;
    for (std::size_t i = begin; i < end; ++i) here += counted(i) ? 1 : 0;
    before[begin / block + 1] = here;
  });
  std::partial_sum(before.begin(), before.end(), before.begin());
  return before;
}

/// The number of i below `count` for which work(i) is true; calls it once for each, on all threads.
template <typename Work>
std::size_t count_where(std::size_t count, const Work& work) {
  return counts_before_blocks(count, 1 << 14, work).back();
}

}  // namespace pcednet
