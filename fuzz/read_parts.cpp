#include <cstdlib>

#include "in_memory.h"
#include "pcednet/formats/parts.h"
#include "pcednet/formats/read_cloud.h"
#include "pcednet/io/parts.h"

namespace {

/// Inputs readable in parts are also read whole, with the same result.
void read_both_ways(const std::filesystem::path& path) {
  const auto reader = pcednet::formats::open_parts(path, 5);
  if (!reader) return;
  std::size_t points = 0;
  for (std::size_t p = 0; p < reader->parts(); ++p) {
    const auto part = reader->read(p);
    check_consistent(part);
    points += part.size();
  }
  if (points != pcednet::formats::read_cloud(path).cloud.size()) std::abort();
}

}  // namespace

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  return pcednet::fuzz::read_or_refuse({data, size}, read_both_ways);
}
