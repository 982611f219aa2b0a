#pragma once

#include <cstddef>
#include <span>

namespace pcednet::io {

/// Undoes LZF, the compression of PCD: a control byte below 32 is followed by that many bytes plus
/// one; any other holds the length (3 bits, then a byte more if they are all set, plus 2) and the
/// high bits of the distance (5 bits, a byte, plus 1) of bytes to repeat.
///
/// False if `packed` is damaged or does not fill `bytes` exactly; any input is safe.
bool unpack_lzf(std::span<const std::byte> packed, std::span<std::byte> bytes);

}  // namespace pcednet::io
