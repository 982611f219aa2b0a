#pragma once

#include <cstddef>
#include <functional>
#include <string>

#include "pcednet/core/output_file.h"

namespace pcednet::io {

/// Writes `count` points block by block: `encode(begin, end, out)` appends the bytes of [begin,
/// end) to `out`, on all threads; blocks reach the file in order.
void write_blocks(OutputFile& file, std::size_t count,
                  const std::function<void(std::size_t, std::size_t, std::string&)>& encode);

}  // namespace pcednet::io
