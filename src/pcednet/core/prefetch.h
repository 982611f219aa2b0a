#pragma once

#include <cstddef>
#include <span>

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

/// Prefetches elements that follow each other in memory.
template <typename Element>
void prefetch_all(std::span<const Element> elements) {
  constexpr std::size_t kCacheLine = 64;
  const auto bytes = std::as_bytes(elements);
  for (std::size_t i = 0; i < bytes.size(); i += kCacheLine) __builtin_prefetch(&bytes[i]);
}

}  // namespace pcednet
