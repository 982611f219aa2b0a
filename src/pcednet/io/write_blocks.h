#pragma once

#include <cstddef>
#include <functional>
#include <string>
#include <string_view>

#include "pcednet/core/output_file.h"

namespace pcednet::io {

/// Appends the bytes of the points [begin, end) to `out`.
using EncodePoints = std::function<void(std::size_t begin, std::size_t end, std::string& out)>;

/// Writes `count` points block by block: encoded on all threads, written in order.
void write_blocks(OutputFile& file, std::size_t count, const EncodePoints& encode);
void write_blocks(const std::function<void(std::string_view)>& write, std::size_t count,
                  const EncodePoints& encode);

}  // namespace pcednet::io
