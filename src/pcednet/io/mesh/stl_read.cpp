#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <bit>
#include <cstring>
#include <numeric>
#include <utility>

#include "pcednet/io/file_lines.h"
#include "pcednet/io/mesh/stl.h"
#include "pcednet/io/ply/faces.h"
#include "pcednet/io/text_scan.h"

namespace pcednet::io {
namespace {

constexpr std::uint64_t kBytesOfStlHeader = 84;  // 80 of any kind, then the count
constexpr std::size_t kBytesOfTriangle = 50;     // normal, three corners, two bytes of attributes
constexpr std::uint64_t kMostTriangles = 0x7fffffff / 3;  // PLY numbers vertices with an int

/// The corners of the triangles, three after three.
struct Corners {
  std::vector<Vec3> positions;
  std::vector<std::string> warnings;
};

std::uint32_t stl_count(const InputFile& file) {
  std::uint32_t count = 0;
  file.read(kBytesOfStlHeader - sizeof count, std::as_writable_bytes(std::span(&count, 1)));
  return count;
}

/// Whether a file of another size than its count says is a text.
bool begins_as_ascii_stl(const InputFile& file) {
  const std::string start = file.text(0, 512);
  std::string_view text = without_mark(start);
  text = text.substr(std::min(text.find_first_not_of(" \t\r\n"), text.size()));
  return lower_case(text.substr(0, 5)) == "solid" && start.find('\0') == std::string::npos;
}

void append_triangle(const std::byte* row, std::vector<Vec3>& positions) {
  std::array<float, 9> corners;
  std::memcpy(corners.data(), row + 12, sizeof corners);
  for (std::size_t c = 0; c < 9; c += 3) {
    positions.emplace_back(corners[c], corners[c + 1], corners[c + 2]);
  }
}

Corners read_binary_stl(const InputFile& file) {
  const std::uint64_t count = stl_count(file), left = file.size() - kBytesOfStlHeader;
  if (count > std::min(left / kBytesOfTriangle, kMostTriangles)) {
    throw unreadable(file.path(),
                     fmt::format("declares {} triangles of {} bytes, but ends {} bytes after byte "
                                 "{}; an ASCII STL begins with solid",
                                 count, kBytesOfTriangle, left, kBytesOfStlHeader));
  }
  Corners corners;
  corners.positions.reserve(3 * count);
  std::vector<std::byte> rows;
  std::size_t with_attributes = 0;
  constexpr std::uint64_t kAtOnce = 1 << 14;
  for (std::uint64_t begin = 0; begin < count; begin += kAtOnce) {
    rows.resize(std::min(kAtOnce, count - begin) * kBytesOfTriangle);
    file.read(kBytesOfStlHeader + begin * kBytesOfTriangle, rows);
    for (std::size_t at = 0; at < rows.size(); at += kBytesOfTriangle) {
      append_triangle(rows.data() + at, corners.positions);
      with_attributes += rows[at + 48] != std::byte{0} || rows[at + 49] != std::byte{0} ? 1 : 0;
    }
  }
  if (with_attributes > 0) {
    corners.warnings.push_back(
        fmt::format("the attributes (colours) of {} triangles are not kept", with_attributes));
  }
  if (const std::uint64_t unread = left - count * kBytesOfTriangle) {
    corners.warnings.push_back(
        fmt::format("{} bytes after the last triangle were not read", unread));
  }
  return corners;
}

/// Reads the statements of an ASCII STL, one a line.
class AsciiStl {
 public:
  explicit AsciiStl(const InputFile& file) : path_(file.path()), lines_(file) {}

  Corners read() {
    bool is_open = false;
    for (std::string_view line; lines_.next_filled(line);) {
      split(line, words_);
      const std::string keyword = lower_case(words_[0]);
      if (keyword == "vertex") {
        add_vertex();
      } else if (keyword == "endfacet") {
        if (vertices_ != 3) throw error(fmt::format("a facet of {} vertices, not 3", vertices_));
        vertices_ = 0;
      } else if (keyword == "facet" || keyword == "solid" || keyword == "endsolid") {
        if (vertices_ != 0) throw error(keyword + " within a facet");
        is_open = keyword != "endsolid";
      } else if (keyword != "outer" && keyword != "endloop") {
        throw error(fmt::format("expected a statement of STL, not {:.40}", words_[0]));
      }
    }
    if (vertices_ != 0) throw error("ends within a facet");
    if (is_open) corners_.warnings.emplace_back("ends without endsolid: it may be cut off");
    return std::move(corners_);
  }

 private:
  Error error(const std::string& what) const { return unreadable(path_, what, lines_.number()); }

  void add_vertex() {
    if (words_.size() != 4) throw error("expected vertex x y z");
    if (++vertices_ > 3) throw error("a facet of more than 3 vertices");
    Vec3 position;
    for (int axis = 0; axis < 3; ++axis) {
      const std::string_view word = words_[static_cast<std::size_t>(axis) + 1];
      const auto number = parse_double(word);
      if (!number) throw error(number_fault(word));
      position[axis] = *number;
    }
    corners_.positions.push_back(position);
  }

  const std::filesystem::path& path_;
  FileLines lines_;
  std::vector<std::string_view> words_;
  std::size_t vertices_ = 0;  ///< of the facet so far
  Corners corners_;
};

/// Keeps one of equal positions, in their order, and gives the new number of each old one.
std::vector<std::uint32_t> merge_equal(std::vector<Vec3>& positions) {
  const auto bits = [&](std::uint32_t i) {  // of numbers that may be NaN; -0 is 0
    const Vec3& p = positions[i];
    return std::array{std::bit_cast<std::uint64_t>(p.x() + 0.0),
                      std::bit_cast<std::uint64_t>(p.y() + 0.0),
                      std::bit_cast<std::uint64_t>(p.z() + 0.0)};
  };
  std::vector<std::uint32_t> order(positions.size()), number(positions.size());
  std::iota(order.begin(), order.end(), 0u);
  std::sort(order.begin(), order.end(), [&](std::uint32_t a, std::uint32_t b) {
    return std::pair(bits(a), a) < std::pair(bits(b), b);
  });
  for (std::size_t i = 0; i < order.size(); ++i) {  // the first of its equals
    const bool is_equal = i > 0 && bits(order[i]) == bits(order[i - 1]);
    number[order[i]] = is_equal ? number[order[i - 1]] : order[i];
  }
  std::uint32_t kept = 0;
  for (std::uint32_t i = 0; i < number.size(); ++i) {
    const bool is_first = number[i] == i;
    if (is_first) positions[kept] = positions[i];
    number[i] = is_first ? kept++ : number[number[i]];
  }
  positions.resize(kept);
  return number;
}

}  // namespace

LoadedCloud read_stl(const InputFile& file) {
  const bool has_header = file.size() >= kBytesOfStlHeader;
  const bool fits =
      has_header &&
      file.size() == kBytesOfStlHeader + std::uint64_t{stl_count(file)} * kBytesOfTriangle;
  const bool is_ascii = !fits && begins_as_ascii_stl(file);
  if (!is_ascii && !has_header) {
    throw unreadable(file.path(), fmt::format("ends after {} bytes: a binary STL has {} or more, "
                                              "an ASCII one begins with solid",
                                              file.size(), kBytesOfStlHeader));
  }
  Corners corners = is_ascii ? AsciiStl(file).read() : read_binary_stl(file);
  if (corners.positions.size() / 3 > kMostTriangles) {
    throw unreadable(file.path(), fmt::format("more than {} triangles", kMostTriangles));
  }
  LoadedCloud loaded;
  loaded.warnings = std::move(corners.warnings);
  const std::size_t triangles = corners.positions.size() / 3;
  const std::vector<std::uint32_t> vertices = merge_equal(corners.positions);
  loaded.cloud.positions = std::move(corners.positions);
  if (!is_ascii) loaded.cloud.position_type = ScalarType::kFloat32;
  if (triangles > 0) {
    loaded.cloud.foreign_elements = {
        make_face_element(std::vector<std::uint32_t>(triangles, 3), vertices)};
  }
  return loaded;
}

}  // namespace pcednet::io
