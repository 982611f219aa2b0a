#include "pcednet/io/ply/faces.h"

#include <fmt/format.h>

#include <algorithm>
#include <string_view>

#include "pcednet/core/error.h"
#include "pcednet/io/ply/header.h"
#include "pcednet/io/text_scan.h"

namespace pcednet::io {
namespace {

/// The rows of a foreign element, read from first to last.
class Rows {
 public:
  explicit Rows(const std::vector<std::byte>& bytes) : bytes_(bytes) {}

  std::uint64_t face = 0;  ///< its number, for messages

  double number(ScalarType type) {
    if (bytes_.size() - at_ < size_of(type)) {
      throw Error(ErrorKind::kUnreadable, fmt::format("the data end in face {}", face));
    }
    const double number = to_double(type, bytes_.data() + at_);
    at_ += size_of(type);
    return number;
  }

 private:
  const std::vector<std::byte>& bytes_;
  std::size_t at_ = 0;
};

void append_fan(const std::vector<double>& corners, std::uint64_t face, std::size_t points,
                std::vector<Triangle>& triangles) {
  for (const double corner : corners) {
    if (corner >= 0.0 && corner < static_cast<double>(points)) continue;
    throw Error(ErrorKind::kUnreadable,
                fmt::format("face {} names vertex {} of {}", face, corner, points));
  }
  const auto index = [&](std::size_t c) { return static_cast<std::uint32_t>(corners[c]); };
  for (std::size_t c = 2; c < corners.size(); ++c) {
    triangles.push_back({index(0), index(c - 1), index(c)});
  }
}

/// Appends the index in little-endian order.
void append_index(std::uint32_t index, std::size_t bytes, ForeignElement& element) {
  const auto* first = reinterpret_cast<const std::byte*>(&index);
  element.bytes.insert(element.bytes.end(), first, first + bytes);
}

bool names_corners(const PlyProperty& property) {
  return property.length_type &&
         (property.name == "vertex_indices" || property.name == "vertex_index");
}

}  // namespace

ForeignElement make_face_element(const std::vector<std::uint32_t>& sizes,
                                 const std::vector<std::uint32_t>& corners) {
  const bool small = std::all_of(sizes.begin(), sizes.end(), [](auto n) { return n < 256; });
  ForeignElement element;
  element.header = fmt::format("element face {}\nproperty list {} int vertex_indices\n",
                               sizes.size(), small ? "uchar" : "uint");
  auto corner = corners.begin();
  for (const std::uint32_t size : sizes) {
    append_index(size, small ? 1 : 4, element);
    for (std::uint32_t c = 0; c < size; ++c) append_index(*corner++, 4, element);
  }
  return element;
}

ForeignElement make_edge_element(const std::vector<std::uint32_t>& ends) {
  ForeignElement element;
  element.header =
      fmt::format("element edge {}\nproperty int vertex1\nproperty int vertex2\n", ends.size() / 2);
  for (const std::uint32_t end : ends) append_index(end, 4, element);
  return element;
}

std::size_t face_count(const PointCloud& cloud) {
  constexpr std::string_view kStart = "element face ";
  for (const ForeignElement& foreign : cloud.foreign_elements) {
    std::string_view header = foreign.header;
    if (!header.starts_with(kStart)) continue;
    header = header.substr(kStart.size());
    return parse_count(trim(header.substr(0, header.find('\n')))).value_or(0);
  }
  return 0;
}

std::string note_on_faces(const PointCloud& cloud) {
  const std::size_t faces = face_count(cloud);
  if (faces == 0) return "";
  return fmt::format(
      "{} faces are not used, only their vertices: pcednet convert --sample N samples points on "
      "faces",
      faces);
}

std::vector<Triangle> triangles_of(const PointCloud& cloud) {
  std::vector<Triangle> triangles;
  std::vector<double> corners;
  for (const ForeignElement& foreign : cloud.foreign_elements) {
    if (!foreign.header.starts_with("element face ")) continue;
    const PlyHeader header = parse_ply_header(
        "faces", "ply\nformat binary_little_endian 1.0\n" + foreign.header + "end_header\n");
    const PlyElement& face = header.elements.front();
    if (face.properties.empty()) continue;  // any number of rows in no bytes
    Rows rows(foreign.bytes);
    for (rows.face = 0; rows.face < face.count; ++rows.face) {
      for (const PlyProperty& property : face.properties) {
        const double count = property.length_type ? rows.number(*property.length_type) : 1.0;
        corners.clear();
        for (double c = 0.0; c < count; ++c) corners.push_back(rows.number(property.type));
        if (names_corners(property)) append_fan(corners, rows.face, cloud.size(), triangles);
      }
    }
  }
  return triangles;
}

}  // namespace pcednet::io
