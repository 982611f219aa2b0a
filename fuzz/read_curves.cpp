#include "pcednet/io/drawing/read_curves.h"
#include "in_memory.h"
#include "pcednet/core/error.h"
#include "pcednet/io/ply/ply.h"

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  return pcednet::fuzz::read_or_refuse({data, size}, [](const std::filesystem::path& path) {
    const pcednet::io::InputFile file(path);
    const bool is_ply = pcednet::io::begins_as_ply(file.text(0, 16));
    const auto curves =
        is_ply ? pcednet::io::read_ply_curves(file) : pcednet::io::read_obj_curves(file);
    for (const auto& curve : curves) {
      if (curve.points.size() < 2) std::abort();
    }
  });
}
