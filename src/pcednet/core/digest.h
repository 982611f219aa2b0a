#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <span>
#include <string>
#include <string_view>

namespace pcednet {

/// 128 bits that tell contents apart: equal contents have equal digests, different ones practically
/// never (XXH3). No protection against somebody who wants them equal.
class Digest {
 public:
  /// What is added in two calls differs from the same bytes added in one.
  Digest& add(std::span<const std::byte> bytes);
  Digest& add(std::string_view text) { return add(std::as_bytes(std::span(text))); }

  /// Of numbers their bytes count: T must have no padding.
  template <typename T>
  Digest& add_values(std::span<const T> values) {
    return add(std::as_bytes(values));
  }

  std::array<std::uint64_t, 2> lanes() const { return state_; }
  std::string hex() const;  ///< 32 digits

 private:
  std::array<std::uint64_t, 2> state_ = {};
};

}  // namespace pcednet
