#include <fmt/format.h>

#include "pcednet/core/error.h"
#include "pcednet/core/version.h"
#include "pcednet/io/drawing/line_classes.h"
#include "pcednet/io/drawing/writers.h"

namespace pcednet::io {
namespace {

std::string ply_header(const LineMesh& mesh, std::size_t edges) {
  return fmt::format(
      "ply\nformat binary_little_endian 1.0\ncomment pcednet {}: {} curves\n"
      "comment classes 1 smooth-edge, 2 sharp-edge, 3 boundary\n"
      "element vertex {}\nproperty double x\nproperty double y\nproperty double z\n"
      "element edge {}\nproperty int vertex1\nproperty int vertex2\nproperty uchar class\n"
      "property int curve\nend_header\n",
      kVersion, mesh.chains.size(), mesh.vertices.size(), edges);
}

}  // namespace

void write_ply_edges(const std::filesystem::path& path, Curves curves,
                     const DrawingOptions& options) {
  const LineMesh mesh = line_mesh(curves, options);
  std::size_t edges = 0;
  for (const auto& chain : mesh.chains) edges += chain.size() - 1;
  if (std::max(mesh.vertices.size(), edges) > INT32_MAX) {
    throw Error(ErrorKind::kFailure, path.string() + ": more vertices or edges than PLY can count");
  }
  std::string bytes = ply_header(mesh, edges);
  for (const Vec3& vertex : mesh.vertices) {
    for (const double coordinate : vertex) append_little(bytes, coordinate);
  }
  for (std::size_t c = 0; c < curves.size(); ++c) {
    const auto& chain = mesh.chains[c];
    for (std::size_t v = 1; v < chain.size(); ++v) {
      append_little(bytes, static_cast<std::int32_t>(chain[v - 1]));
      append_little(bytes, static_cast<std::int32_t>(chain[v]));
      append_little(bytes, static_cast<std::uint8_t>(line_class(curves[c].edge_class).edge_class));
      append_little(bytes, static_cast<std::int32_t>(c));
    }
  }
  write_text_file(path, bytes, options.overwrite);
}

}  // namespace pcednet::io
