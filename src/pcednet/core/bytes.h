#pragma once

#include <cstring>
#include <type_traits>

namespace pcednet {

/// The value whose bytes are at `from`, which need not be aligned.
template <typename T>
T load(const void* from) {
  static_assert(std::is_trivially_copyable_v<T>);
  T value = {};
  std::memcpy(&value, from, sizeof value);
  return value;
}

/// Copies the bytes of a value to `to`, which need not be aligned.
template <typename T>
void store(void* to, const T& value) {
  static_assert(std::is_trivially_copyable_v<T>);
  std::memcpy(to, &value, sizeof value);
}

}  // namespace pcednet
