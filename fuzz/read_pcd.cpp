#include "in_memory.h"
#include "pcednet/io/pcd/pcd.h"

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  return pcednet::fuzz::read_or_refuse({data, size}, [](const std::filesystem::path& path) {
    check_consistent(pcednet::io::read_pcd(pcednet::io::InputFile(path)).cloud);
  });
}
