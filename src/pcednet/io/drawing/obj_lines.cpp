#include <fmt/format.h>

#include "pcednet/core/version.h"
#include "pcednet/io/drawing/line_classes.h"
#include "pcednet/io/drawing/writers.h"

namespace pcednet::io {
namespace {

void append_curve(std::string& text, const lines::Curve& curve,
                  const std::vector<std::size_t>& chain) {
  text += fmt::format("# {} {}, length {}, confidence {}", line_class(curve.edge_class).name,
                      name_of(curve.kind), length_of(curve), curve.confidence);
  if (curve.radius > 0.0) text += fmt::format(", radius {}", curve.radius);
  text += "\nl";
  for (const std::size_t vertex : chain) text += fmt::format(" {}", vertex + 1);
  text += '\n';
}

}  // namespace

void write_obj_lines(const std::filesystem::path& path, Curves curves,
                     const DrawingOptions& options) {
  const LineMesh mesh = line_mesh(curves, options);
  std::string text = fmt::format("# pcednet {}: {} curves, one l each\n", kVersion, curves.size());
  for (const Vec3& v : mesh.vertices) {
    text += fmt::format("v {} {} {}\n", v.x(), v.y(), v.z());
  }
  for (const LineClass& group : kLineClasses) {
    bool is_named = false;
    for (std::size_t i = 0; i < curves.size(); ++i) {
      if (&line_class(curves[i].edge_class) != &group) continue;
      if (!is_named) text += fmt::format("o {}\n", group.name);
      is_named = true;
      append_curve(text, curves[i], mesh.chains[i]);
    }
  }
  write_text_file(path, text, options.overwrite);
}

}  // namespace pcednet::io
