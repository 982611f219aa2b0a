#pragma once

#include <array>
#include <cstdint>

namespace pcednet::spatial {

/// Spreads the lowest 21 bits so that two zero bits follow each of them.
inline std::uint64_t spread_bits(std::uint64_t v) {
  v &= 0x1fffff;
  v = (v | v << 32) & 0x1f00000000ffff;
  v = (v | v << 16) & 0x1f0000ff0000ff;
  v = (v | v << 8) & 0x100f00f00f00f00f;
  v = (v | v << 4) & 0x10c30c30c30c30c3;
  v = (v | v << 2) & 0x1249249249249249;
  return v;
}

/// The place of a grid cell on the Morton curve: the bits of its coordinates (at most 21 each)
/// interleaved, x highest.
inline std::uint64_t morton_code(const std::array<std::uint32_t, 3>& cell) {
  return spread_bits(cell[0]) << 2 | spread_bits(cell[1]) << 1 | spread_bits(cell[2]);
}

}  // namespace pcednet::spatial
