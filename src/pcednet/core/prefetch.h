#pragma once

#include <cstddef>

namespace pcednet {

/// How many iterations ahead a loop over scattered elements prefetches.
inline constexpr std::size_t kAskAhead = 16;

/// Prefetches an element, which may straddle two cache lines.
template <typename Element>
void prefetch(const Element& element) {
  const auto* bytes = reinterpret_cast<const std::byte*>(&element);
  __builtin_prefetch(bytes);
  __builtin_prefetch(bytes + sizeof(Element) - 1);
}

}  // namespace pcednet
