#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <span>
#include <string>
#include <string_view>

namespace pcednet {

/// A 128-bit digest (XXH3): different contents practically never have equal digests. It does not
/// protect against deliberate collisions.
class Digest {
 public:
  /// Not concatenation: add(a), add(b) differs from add(a + b).
  Digest& add(std::span<const std::byte> bytes);
  Digest& add(std::string_view text) { return add(std::as_bytes(std::span(text))); }

  /// Adds the bytes of the numbers; T must have no padding.
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
