#include "pcednet/io/e57/pages.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cstring>

#include "pcednet/core/bytes.h"

namespace pcednet::io {
namespace {

using Table = std::array<std::array<std::uint32_t, 256>, 8>;

/// Entry [k][b] is the remainder of byte b followed by k zero bytes.
constexpr Table make_table() {
  constexpr std::uint32_t kPolynomial = 0x82F63B78;  // reflected
  Table table = {};
  for (std::uint32_t byte = 0; byte < 256; ++byte) {
    std::uint32_t rest = byte;
    for (int bit = 0; bit < 8; ++bit) rest = (rest >> 1) ^ ((rest & 1) != 0 ? kPolynomial : 0);
    table[0][byte] = rest;
  }
  for (std::size_t k = 1; k < table.size(); ++k) {
    for (std::size_t byte = 0; byte < 256; ++byte) {
      const std::uint32_t before = table[k - 1][byte];
      table[k][byte] = (before >> 8) ^ table[0][before & 0xFF];
    }
  }
  return table;
}

constexpr Table kTable = make_table();

std::uint32_t stored_checksum(std::span<const std::byte> page) {
  std::uint32_t sum = 0;
  for (std::size_t i = kE57PageContent; i < kE57PageBytes; ++i) {
    sum = (sum << 8) | std::to_integer<std::uint32_t>(page[i]);
  }
  return sum;
}

}  // namespace

std::uint32_t crc32c(std::span<const std::byte> bytes) {
  std::uint32_t rest = 0xFFFFFFFF;
  for (; bytes.size() >= 8; bytes = bytes.subspan(8)) {
    const std::uint64_t word = load<std::uint64_t>(&bytes[0]) ^ rest;
    rest = 0;
    for (std::size_t k = 0; k < 8; ++k) rest ^= kTable[7 - k][(word >> (8 * k)) & 0xFF];
  }
  for (const std::byte byte : bytes) {
    rest = (rest >> 8) ^ kTable[0][(rest ^ std::to_integer<std::uint32_t>(byte)) & 0xFF];
  }
  return ~rest;
}

bool begins_as_e57(std::string_view start) {
  return start.starts_with("ASTM-E57");
}

E57Pages::E57Pages(const InputFile& file) : file_(file) {
  std::array<std::byte, 48> start = {};
  file.read(0, start);
  if (!begins_as_e57({reinterpret_cast<const char*>(start.data()), start.size()})) {
    throw unreadable(file.path(), "not an E57 file: it must begin with ASTM-E57");
  }
  const auto major = load<std::uint32_t>(&start[8]);
  const auto bytes = load<std::uint64_t>(&start[16]);
  const auto page = load<std::uint64_t>(&start[40]);
  if (major != 1 || page != kE57PageBytes) {
    throw unreadable(file.path(), fmt::format("E57 version {} in pages of {} bytes; accepted: "
                                              "version 1 in pages of 1024",
                                              major, page));
  }
  if (bytes > file.size()) {
    throw unreadable(file.path(),
                     fmt::format("declares {} bytes, but holds {}", bytes, file.size()));
  }
  header_ = {load<std::uint64_t>(&start[24]), load<std::uint64_t>(&start[32])};
  size_ = bytes / kE57PageBytes * kE57PageContent;
}

std::uint64_t E57Pages::logical(std::uint64_t physical, const char* what) const {
  const std::uint64_t within = physical % kE57PageBytes;
  const std::uint64_t offset = physical / kE57PageBytes * kE57PageContent + within;
  if (within >= kE57PageContent || offset >= size_) {
    throw unreadable(file_.path(), fmt::format("{}: there is no byte {} for it", what, physical));
  }
  return offset;
}

void E57Pages::read(std::uint64_t offset, std::span<std::byte> bytes) const {
  constexpr std::uint64_t kPagesAtOnce = 64;
  if (offset > size_ || bytes.size() > size_ - offset) {
    throw unreadable(file_.path(),
                     fmt::format("ends {} bytes too early, at byte {} of its pages",
                                 bytes.size() - (size_ - std::min(offset, size_)), size_));
  }
  std::array<std::byte, kPagesAtOnce * kE57PageBytes> buffer;
  while (!bytes.empty()) {
    const std::uint64_t first = offset / kE57PageContent;
    const std::uint64_t last = (offset + bytes.size() - 1) / kE57PageContent;
    const std::uint64_t pages = std::min(last - first + 1, kPagesAtOnce);
    file_.read(first * kE57PageBytes, std::span(buffer).first(pages * kE57PageBytes));
    for (std::uint64_t p = 0; p < pages; ++p) {
      const auto page =
          std::span<const std::byte>(buffer).subspan(p * kE57PageBytes, kE57PageBytes);
      if (crc32c(page.first(kE57PageContent)) != stored_checksum(page)) {
        throw unreadable(file_.path(), fmt::format("page {} (byte {}): the checksum is wrong",
                                                   first + p, (first + p) * kE57PageBytes));
      }
      const std::uint64_t from = offset - (first + p) * kE57PageContent;
      const std::uint64_t count = std::min<std::uint64_t>(kE57PageContent - from, bytes.size());
      std::memcpy(bytes.data(), page.data() + from, count);
      bytes = bytes.subspan(count);
      offset += count;
    }
  }
}

}  // namespace pcednet::io
