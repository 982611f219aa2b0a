#include "in_memory.h"
#include "pcednet/io/mesh/stl.h"

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  return pcednet::fuzz::read_or_refuse({data, size}, [](const std::filesystem::path& path) {
    check_consistent(pcednet::io::read_stl(pcednet::io::InputFile(path)).cloud);
  });
}
