#pragma once

#include <cstddef>
#include <cstring>
#include <type_traits>

namespace pcednet::io {

/// Copies `count` numbers of `bytes` bytes each, that lie `from_stride` bytes apart, to places
/// `to_stride` bytes apart.
inline void copy_numbers(const std::byte* from, std::size_t from_stride, std::byte* to,
                         std::size_t to_stride, std::size_t bytes, std::size_t count) {
  const auto copy = [&](auto size) {
    for (std::size_t i = 0; i < count; ++i) {
      std::memcpy(to + i * to_stride, from + i * from_stride, size);
    }
  };
  switch (bytes) {  // sizes that the compiler knows are copied by one instruction
    case 1:
      return copy(std::integral_constant<std::size_t, 1>());
    case 2:
      return copy(std::integral_constant<std::size_t, 2>());
    case 4:
      return copy(std::integral_constant<std::size_t, 4>());
    case 8:
      return copy(std::integral_constant<std::size_t, 8>());
    default:
      return copy(bytes);
  }
}

}  // namespace pcednet::io
