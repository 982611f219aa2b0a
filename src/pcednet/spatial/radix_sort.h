#pragma once

#include <cstdint>
#include <span>

namespace pcednet::spatial {

struct Keyed {
  std::uint64_t key;
  std::uint32_t index;
};

/// Sorts by the lowest `bits` bits of the keys, on all threads; equal keys keep their order. Higher
/// bits must be 0. Takes linear time and as much additional memory as the input.
void sort_by_key(std::span<Keyed> keyed, int bits);

}  // namespace pcednet::spatial
