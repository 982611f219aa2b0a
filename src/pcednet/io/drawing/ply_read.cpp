#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <cstring>
#include <optional>

#include "pcednet/io/drawing/chain.h"
#include "pcednet/io/drawing/line_classes.h"
#include "pcednet/io/drawing/read_curves.h"
#include "pcednet/io/ply.h"
#include "pcednet/io/ply_header.h"
#include "pcednet/io/ply_rows.h"

namespace pcednet::io {
namespace {

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
                         values[p] = visit_scalar(type, [&](auto value) {
                           std::memcpy(&value, number, sizeof value);
                           return static_cast<double>(value);
                         });
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
