#include "pcednet/core/large_pages.h"

#if defined(__linux__)
#include <sys/mman.h>
#endif

#include <cstdint>

namespace pcednet {

void prefer_large_pages([[maybe_unused]] void* memory, [[maybe_unused]] std::size_t bytes) {
#if defined(__linux__) && defined(MADV_HUGEPAGE)
  constexpr std::size_t kPage = 2 << 20;
  if (bytes < 2 * kPage) return;
  const std::size_t before = (kPage - reinterpret_cast<std::uintptr_t>(memory) % kPage) % kPage;
  const std::size_t whole = (bytes - before) / kPage * kPage;
  // Only advice: a refusal changes nothing.
  madvise(static_cast<char*>(memory) + before, whole, MADV_HUGEPAGE);
#endif
}

}  // namespace pcednet
