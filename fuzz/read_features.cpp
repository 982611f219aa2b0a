#include "in_memory.h"
#include "workbench/truth/abc_features.h"

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  return pcednet::fuzz::read_or_refuse({data, size}, [](const std::filesystem::path& path) {
    pcednet::truth::read_abc_labels(path, 1000);
  });
}
