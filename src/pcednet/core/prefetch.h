#pragma once

#include <cstddef>

namespace pcednet {

/// A loop over elements that may be anywhere in memory asks for each so many turns before it reads
/// it.
inline constexpr std::size_t kAskAhead = 16;

/// Asks for an element. Its first and its last byte may lie in two lines of the cache.
template <typename Element>
void prefetch(const Element& element) {
  const auto* bytes = reinterpret_cast<const std::byte*>(&element);
  __builtin_prefetch(bytes);
  __builtin_prefetch(bytes + sizeof(Element) - 1);
}

}  // namespace pcednet
