#include "in_memory.h"
#include "pcednet/detect/model.h"

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  return pcednet::fuzz::read_or_refuse(
      {data, size}, [](const std::filesystem::path& path) { pcednet::detect::load_model(path); });
}
