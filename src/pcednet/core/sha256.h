#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <span>
#include <string>
#include <string_view>

namespace pcednet {

/// SHA-256 (FIPS 180-4), for files whose digest others check with their own tools. Bytes added in
/// pieces count as one message.
class Sha256 {
 public:
  Sha256& add(std::span<const std::byte> bytes);
  Sha256& add(std::string_view text) { return add(std::as_bytes(std::span(text))); }

  /// 64 digits, as sha256sum prints them. Ends the message.
  std::string hex();

 private:
  void block(const std::byte* bytes);

  std::array<std::uint32_t, 8> state_ = {0x6a09e667, 0xbb67ae85, 0x3c6ef372, 0xa54ff53a,
                                         0x510e527f, 0x9b05688c, 0x1f83d9ab, 0x5be0cd19};
  std::array<std::byte, 64> waiting_ = {};
  std::uint64_t bytes_ = 0;
};

/// That of a file's bytes. Throws Error(kUnreadable) if it cannot be read.
std::string sha256_of_file(const std::filesystem::path& path);

}  // namespace pcednet
