#include "pcednet/io/drawing/read_curves.h"

#include "pcednet/io/ply.h"
#include "pcednet/io/text_scan.h"

namespace pcednet::io {

std::vector<lines::Curve> read_curves(const std::filesystem::path& path) {
  const InputFile file(path);
  if (begins_as_ply(file.text(0, 16))) return read_ply_curves(file);
  if (extension_of(path) == ".obj") return read_obj_curves(file);
  throw unreadable(path, "curves are read from .obj and .ply");
}

}  // namespace pcednet::io
