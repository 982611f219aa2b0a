#include "pcednet/io/drawing/read_curves.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <optional>

#include "pcednet/io/drawing/chain.h"
#include "pcednet/io/drawing/line_classes.h"
#include "pcednet/io/mesh/obj_statements.h"
#include "pcednet/io/ply/header.h"
#include "pcednet/io/ply/ply.h"
#include "pcednet/io/ply/rows.h"
#include "pcednet/io/text_scan.h"

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

/// Where the properties are that make curves.
struct EdgeProperties {
  std::size_t from = 0, to = 0;
  std::optional<std::size_t> curve, edge_class;
};

struct EdgeRow {
  std::size_t from = 0, to = 0;
  double curve = 0.0, edge_class = kSharpEdge;
};

std::optional<std::size_t> find_property(const PlyElement& element, std::string_view name) {
  for (std::size_t p = 0; p < element.properties.size(); ++p) {
    if (element.properties[p].name == name && !element.properties[p].length_type) return p;
  }
  return std::nullopt;
}

EdgeProperties edge_properties(const PlyElement& edge, const std::filesystem::path& path) {
  const auto from = find_property(edge, "vertex1"), to = find_property(edge, "vertex2");
  if (from && to) {
    return {*from, *to, find_property(edge, "curve"), find_property(edge, "class")};
  }
  throw Error(ErrorKind::kInsufficient,
              fmt::format("{}: the element edge has no vertex1 and vertex2", path.string()));
}

std::size_t vertex_index(double number, std::size_t vertices) {
  if (number >= 0.0 && number < static_cast<double>(vertices) && number == std::floor(number)) {
    return static_cast<std::size_t>(number);
  }
  throw Error(ErrorKind::kUnreadable, fmt::format("names vertex {} of {}", number, vertices));
}

/// The rows of a foreign element, which its reader has checked and made little-endian.
std::vector<EdgeRow> edge_rows(ForeignElement& foreign, std::size_t vertices,
                               const std::filesystem::path& path) {
  const PlyHeader header = parse_ply_header(
      path, "ply\nformat binary_little_endian 1.0\n" + foreign.header + "end_header\n");
  const PlyElement& edge = header.elements.front();
  const EdgeProperties properties = edge_properties(edge, path);
  std::vector<double> values(edge.properties.size());
  std::vector<EdgeRow> rows;
  std::byte* row = foreign.bytes.data();
  const std::byte* const end = row + foreign.bytes.size();
  for (std::uint64_t i = 0; i < edge.count; ++i) {
    row = walk_ply_row(edge, row, end, false,
                       [&](std::size_t p, const std::byte* number, ScalarType type, bool) {
                         values[p] = to_double(type, number);
                       });
    try {
      rows.push_back({vertex_index(values[properties.from], vertices),
                      vertex_index(values[properties.to], vertices)});
    } catch (const Error& error) {
      throw unreadable(path, fmt::format("row {} of element edge {}", i + 1, error.what()));
    }
    if (properties.curve) rows.back().curve = values[*properties.curve];
    if (properties.edge_class) rows.back().edge_class = values[*properties.edge_class];
  }
  return rows;
}

EdgeClass class_numbered(double number) {
  const auto entry = std::find_if(kLineClasses.begin(), kLineClasses.end(), [&](const auto& known) {
    return static_cast<double>(known.edge_class) == number;
  });
  return entry == kLineClasses.end() ? kSharpEdge : entry->edge_class;
}

/// The curve of consecutive rows that begin at number `first`.
lines::Curve curve_of(std::span<const EdgeRow> rows, std::size_t first,
                      std::span<const Vec3> vertices, const std::filesystem::path& path) {
  std::vector<std::size_t> chain = {rows.front().from};
  for (const EdgeRow& row : rows) chain.push_back(row.to);
  for (const std::size_t vertex : chain) {
    if (is_drawable(vertices[vertex])) continue;
    throw unreadable(path, fmt::format("row {} of element edge: vertex {} is not finite or beyond "
                                       "1e150",
                                       first + 1, vertex));
  }
  lines::Curve curve = curve_along(chain, vertices);
  if (curve.points.size() < 2) {
    throw unreadable(path,
                     fmt::format("row {} of element edge: the line is a single point", first + 1));
  }
  curve.edge_class = class_numbered(rows.front().edge_class);
  return curve;
}

}  // namespace

std::vector<lines::Curve> read_curves(const std::filesystem::path& path) {
  const InputFile file(path);
  if (begins_as_ply(file.text(0, 16))) return read_ply_curves(file);
  if (extension_of(path) == ".obj") return read_obj_curves(file);
  throw unreadable(path, "curves are read from .obj and .ply");
}

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

std::vector<lines::Curve> read_ply_curves(const InputFile& file) {
  PointCloud cloud = read_ply(file).cloud;
  const auto edge = std::find_if(
      cloud.foreign_elements.begin(), cloud.foreign_elements.end(),
      [](const ForeignElement& element) { return element.header.starts_with("element edge "); });
  if (edge == cloud.foreign_elements.end()) {
    throw Error(ErrorKind::kInsufficient,
                fmt::format("{}: has no lines: no element edge", file.path().string()));
  }
  const std::vector<EdgeRow> rows = edge_rows(*edge, cloud.size(), file.path());
  std::vector<lines::Curve> curves;
  for (std::size_t begin = 0; begin < rows.size();) {
    std::size_t end = begin + 1;
    while (end < rows.size() && rows[end].from == rows[end - 1].to &&
           rows[end].curve == rows[begin].curve) {
      ++end;
    }
    curves.push_back(
        curve_of(std::span(rows).subspan(begin, end - begin), begin, cloud.positions, file.path()));
    begin = end;
  }
  return curves;
}

}  // namespace pcednet::io
