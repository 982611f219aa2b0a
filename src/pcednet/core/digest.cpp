#include "pcednet/core/digest.h"

#include <fmt/format.h>
#define XXH_INLINE_ALL
#include <xxhash.h>

namespace pcednet {

Digest& Digest::add(std::span<const std::byte> bytes) {
  const XXH128_hash_t found = XXH3_128bits(bytes.data(), bytes.size());
  const std::array<std::uint64_t, 5> chain = {state_[0], state_[1], bytes.size(), found.low64,
                                              found.high64};
  const XXH128_hash_t next = XXH3_128bits(chain.data(), sizeof chain);
  state_ = {next.low64, next.high64};
  return *this;
}

std::string Digest::hex() const {
  return fmt::format("{:016x}{:016x}", state_[0], state_[1]);
}

}  // namespace pcednet
