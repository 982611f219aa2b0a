#include "pcednet/core/digest.h"

#include <fmt/format.h>

#include <algorithm>
#include <cstring>

namespace pcednet {
namespace {

/// The finaliser of splitmix64: a bijection in which every bit changes about half of all bits.
std::uint64_t mix(std::uint64_t z) {
  z = (z ^ (z >> 30)) * 0xBF58476D1CE4E5B9ull;
  z = (z ^ (z >> 27)) * 0x94D049BB133111EBull;
  return z ^ (z >> 31);
}

constexpr std::uint64_t kStep = 0x9E3779B97F4A7C15ull;

void absorb(std::array<std::uint64_t, 2>& state, std::uint64_t word) {
  state[0] = mix((state[0] ^ word) + kStep);
  state[1] = mix((state[1] + word) * 3 + kStep);
}

}  // namespace

Digest& Digest::add(std::span<const std::byte> bytes) {
  absorb(state_, bytes.size());
  for (std::size_t i = 0; i < bytes.size(); i += sizeof(std::uint64_t)) {
    std::uint64_t word = 0;
    std::memcpy(&word, bytes.data() + i, std::min(sizeof word, bytes.size() - i));
    absorb(state_, word);
  }
  return *this;
}

std::array<std::uint64_t, 2> Digest::lanes() const {
  return {mix(state_[0] + state_[1]), mix(state_[1] ^ (state_[0] * kStep))};
}

std::string Digest::hex() const {
  return fmt::format("{:016x}{:016x}", lanes()[0], lanes()[1]);
}

}  // namespace pcednet
