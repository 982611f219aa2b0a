#include <fmt/format.h>

#include "pcednet/io/drawing/chain.h"
#include "pcednet/io/drawing/line_classes.h"
#include "pcednet/io/drawing/read_curves.h"
#include "pcednet/io/obj_statements.h"

namespace pcednet::io {
namespace {

/// The indices of an `l`, which may name vertices that follow it.
struct ObjLine {
  std::vector<std::size_t> chain;
  EdgeClass edge_class = kSharpEdge;
  std::size_t line = 0;
};

std::vector<std::size_t> chain_of(const ObjStatements& statement, std::size_t vertices_so_far) {
  const auto& words = statement.words();
  if (words.size() < 3) throw statement.error("expected l and two vertices or more");
  std::vector<std::size_t> chain;
  for (std::size_t w = 1; w < words.size(); ++w) {
    const auto vertex = obj_index(words[w].substr(0, words[w].find('/')), vertices_so_far);
    if (!vertex)
      throw statement.error(fmt::format("expected the index of a v, not {:.40}", words[w]));
    chain.push_back(*vertex);
  }
  return chain;
}

Vec3 drawable_vertex(const ObjStatements& statement) {
  Vec3 vertex = statement.vertex();
  if (!is_drawable(vertex)) throw statement.error("a coordinate is not finite or beyond 1e150");
  return vertex;
}

EdgeClass class_named(const std::vector<std::string_view>& words) {
  for (const LineClass& entry : kLineClasses) {
    if (words.size() == 2 && words[1] == entry.name) return entry.edge_class;
  }
  return kSharpEdge;
}

lines::Curve curve_of(const ObjLine& line, std::span<const Vec3> vertices,
                      const std::filesystem::path& path) {
  for (const std::size_t vertex : line.chain) {
    if (vertex < vertices.size()) continue;
    throw unreadable(path, fmt::format("names v number {} of {}", vertex + 1, vertices.size()),
                     line.line);
  }
  lines::Curve curve = curve_along(line.chain, vertices);
  if (curve.points.size() < 2) throw unreadable(path, "the line is a single point", line.line);
  curve.edge_class = line.edge_class;
  return curve;
}

}  // namespace

std::vector<lines::Curve> read_obj_curves(const InputFile& file) {
  const std::string text = file.text();
  std::vector<Vec3> vertices;
  std::vector<ObjLine> found;
  EdgeClass edge_class = kSharpEdge;
  ObjStatements statements(file.path(), text);
  while (statements.next()) {
    const std::string_view keyword = statements.words()[0];
    if (keyword == "v") {
      vertices.push_back(drawable_vertex(statements));
    } else if (keyword == "o" || keyword == "g") {
      edge_class = class_named(statements.words());
    } else if (keyword == "l") {
      found.push_back({chain_of(statements, vertices.size()), edge_class, statements.line()});
    }
  }
  if (found.empty() && !vertices.empty()) {
    throw Error(ErrorKind::kInsufficient,
                fmt::format("{}: has no lines: statements l", file.path().string()));
  }
  std::vector<lines::Curve> curves;
  for (const ObjLine& line : found) curves.push_back(curve_of(line, vertices, file.path()));
  return curves;
}

}  // namespace pcednet::io
