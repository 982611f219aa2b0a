#pragma once

#include <cstddef>
#include <cstdint>
#include <span>

#include "pcednet/io/input_file.h"

namespace pcednet::io {

/// CRC-32C (Castagnoli), RFC 3720, appendix B.4.
std::uint32_t crc32c(std::span<const std::byte> bytes);

inline constexpr std::uint64_t kE57PageBytes = 1024;
inline constexpr std::uint64_t kE57PageContent = 1020;  ///< the rest is its checksum, big-endian

/// The file header of an E57 file.
struct E57Header {
  std::uint64_t xml_offset = 0;  ///< physical
  std::uint64_t xml_bytes = 0;   ///< logical
};

/// The content of the pages of an E57 file (ASTM E2807-11, 7.1): 1020 bytes of each 1024, page by
/// page. Logical offsets count content only, physical ones every byte of the file.
class E57Pages {
 public:
  /// Throws Error(kUnreadable) unless the file begins as E57 of version 1 and is not shorter than
  /// its header states.
  explicit E57Pages(const InputFile& file);

  const InputFile& file() const { return file_; }
  const E57Header& header() const { return header_; }
  std::uint64_t size() const { return size_; }  ///< logical bytes

  /// Throws Error(kUnreadable) for an offset beyond the end or within a checksum; `what` names the
  /// data there.
  std::uint64_t logical(std::uint64_t physical, const char* what) const;

  /// Fills `bytes` from the logical offset. Throws Error(kUnreadable), naming the page, where a
  /// checksum is wrong, and naming the byte if the pages end before.
  void read(std::uint64_t offset, std::span<std::byte> bytes) const;

 private:
  const InputFile& file_;
  E57Header header_;
  std::uint64_t size_ = 0;
};

}  // namespace pcednet::io
