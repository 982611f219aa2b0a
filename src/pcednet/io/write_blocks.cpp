#include "pcednet/io/write_blocks.h"

#include <algorithm>
#include <array>

#include "pcednet/core/parallel.h"

namespace pcednet::io {

void write_blocks(OutputFile& file, std::size_t count, const EncodePoints& encode) {
  write_blocks([&](std::string_view bytes) { file.write(bytes); }, count, encode);
}

void write_blocks(const std::function<void(std::string_view)>& write, std::size_t count,
                  const EncodePoints& encode) {
  constexpr std::size_t kBlock = 8192;
  constexpr std::size_t kBlocksAtOnce = 32;
  std::array<std::string, kBlocksAtOnce> buffers;
  for (std::size_t start = 0; start < count; start += kBlock * kBlocksAtOnce) {
    const std::size_t points = std::min(count - start, kBlock * kBlocksAtOnce);
    for (std::string& buffer : buffers) buffer.clear();
    parallel_blocks(points, kBlock, [&](std::size_t begin, std::size_t end) {
      encode(start + begin, start + end, buffers[begin / kBlock]);
    });
    for (const std::string& buffer : buffers) write(buffer);
  }
}

}  // namespace pcednet::io
