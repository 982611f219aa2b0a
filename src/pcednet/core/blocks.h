#pragma once

#include <algorithm>
#include <cstddef>

namespace pcednet {

/// Calls work(begin, end) for consecutive ranges of the numbers 0 to `count`, each of `block`
/// numbers but the last.
template <typename Work>
void for_each_block(std::size_t count, std::size_t block, const Work& work) {
  for (std::size_t begin = 0; begin < count; begin += block) {
    work(begin, std::min(begin + block, count));
  }
}

}  // namespace pcednet
