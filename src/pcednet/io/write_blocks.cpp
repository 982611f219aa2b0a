#include "pcednet/io/write_blocks.h"

#include <algorithm>
#include <array>

#include "pcednet/core/parallel.h"

namespace pcednet::io {

void write_blocks(OutputFile& file, std::size_t count,
                  const std::function<void(std::size_t, std::size_t, std::string&)>& encode) {
  constexpr std::size_t kBlock = 8192;
  constexpr std::size_t kBlocksAtOnce = 32;
  std::array<std::string, kBlocksAtOnce> buffers;
  for (std::size_t start = 0; start < count; start += kBlock * kBlocksAtOnce) {
    const std::size_t points = std::min(count - start, kBlock * kBlocksAtOnce);
    for (std::string& buffer : buffers) buffer.clear();
    parallel_blocks(points, kBlock, [&](std::size_t begin, std::size_t end) {
      encode(start + begin, start + end, buffers[begin / kBlock]);
    });
    for (const std::string& buffer : buffers) file.write(buffer);
  }
}

}  // namespace pcednet::io
