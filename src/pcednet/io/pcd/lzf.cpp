#include "pcednet/io/pcd/lzf.h"

#include <algorithm>

namespace pcednet::io {

bool unpack_lzf(std::span<const std::byte> packed, std::span<std::byte> bytes) {
  std::size_t in = 0, out = 0;
  while (in < packed.size()) {
    const auto control = static_cast<std::size_t>(packed[in++]);
    if (control < 32) {
      const std::size_t length = control + 1;
      if (length > packed.size() - in || length > bytes.size() - out) return false;
      std::copy_n(packed.begin() + static_cast<std::ptrdiff_t>(in), length,
                  bytes.begin() + static_cast<std::ptrdiff_t>(out));
      in += length;
      out += length;
      continue;
    }
    std::size_t length = control >> 5;
    if (packed.size() - in < (length == 7 ? 2u : 1u)) return false;
    if (length == 7) length += static_cast<std::size_t>(packed[in++]);
    length += 2;
    const std::size_t distance = ((control & 31) << 8) + static_cast<std::size_t>(packed[in++]) + 1;
    if (distance > out || length > bytes.size() - out) return false;
    // Byte by byte: the bytes to repeat may overlap those they make.
    for (const std::size_t end = out + length; out < end; ++out) bytes[out] = bytes[out - distance];
  }
  return out == bytes.size();
}

}  // namespace pcednet::io
