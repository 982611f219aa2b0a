#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <utility>

#include "pcednet/io/file_lines.h"
#include "pcednet/io/mesh/off.h"
#include "pcednet/io/ply/faces.h"
#include "pcednet/io/promote.h"
#include "pcednet/io/text_scan.h"

namespace pcednet::io {
namespace {

constexpr std::uint64_t kMostVertices = 0x7fffffff;  // PLY numbers vertices with an int

/// The numbers that the keyword announces for every vertex behind x y z.
struct VertexLayout {
  bool normals = false, colours = false, texture = false;

  std::size_t least_numbers() const {
    return 3 + (normals ? 3u : 0u) + (colours ? 3u : 0u) + (texture ? 2u : 0u);
  }
};

class OffText {
 public:
  explicit OffText(const InputFile& file) : path_(file.path()), size_(file.size()), lines_(file) {}

  LoadedCloud read() {
    read_counts();
    for (std::uint64_t i = 0; i < vertices_; ++i) read_vertex(i);
    for (std::uint64_t i = 0; i < faces_; ++i) read_face(i);
    if (!colours_[0].empty()) add_colours(colours_, cloud_, loaded_.warnings);
    if (!alphas_.empty() && alphas_.size() == cloud_.size()) {
      cloud_.attributes.push_back(make_attribute("alpha", alphas_));
    } else if (!alphas_.empty()) {
      loaded_.warnings.push_back(
          fmt::format("alphas of {} of {} vertices are not kept", alphas_.size(), cloud_.size()));
    }
    if (!sizes_.empty()) cloud_.foreign_elements = {make_face_element(sizes_, corners_)};
    warn_of_omissions();
    return std::move(loaded_);
  }

 private:
  Error error(const std::string& what) const { return unreadable(path_, what, lines_.number()); }

  /// Moves to the next line that holds more than a comment; false after the last.
  bool next(std::string_view& line) {
    while (lines_.next_filled(line)) {
      line = trim(line);
      const std::size_t comment = line.find('#');
      if (comment == 0) cloud_.comments.emplace_back(trim(line.substr(1)));
      line = line.substr(0, comment);
      if (!trim(line).empty()) return true;
    }
    return false;
  }

  double number(std::string_view word) const {
    const auto value = parse_double(word);
    if (!value) throw error(number_fault(word));
    return *value;
  }

  /// Takes the keyword off `line` and its meaning into layout_.
  void take_keyword(std::string_view& line) {
    const std::size_t keyword = line.find("OFF");
    if (keyword == std::string_view::npos) return;
    for (std::string_view flags = line.substr(0, keyword); !flags.empty();) {
      const bool is_texture = flags.starts_with("ST");
      if (is_texture) {
        layout_.texture = true;
      } else if (flags.front() == 'C') {
        layout_.colours = true;
      } else if (flags.front() == 'N') {
        layout_.normals = true;
      } else {
        throw error(fmt::format("expected OFF, or C, N or ST before it, not {:.40}", line));
      }
      flags.remove_prefix(is_texture ? 2 : 1);
    }
    line = trim(line.substr(keyword + 3));
    if (line.starts_with("BINARY")) throw error("binary OFF is not read; save it as text");
  }

  void read_counts() {
    std::string_view line;
    if (!next(line)) throw error("expected OFF and the counts of vertices, faces and edges");
    take_keyword(line);
    if (line.empty() && !next(line)) throw error("ends before the counts of vertices and faces");
    split(line, words_);
    const auto vertices = parse_count(words_[0]);
    const auto faces = words_.size() > 1 ? parse_count(words_[1]) : std::nullopt;
    if (!vertices || !faces || words_.size() > 3) {
      throw error(
          fmt::format("expected the counts of vertices, faces and edges, not {:.60}", line));
    }
    if (*vertices > kMostVertices) throw error(fmt::format("more than {} vertices", kMostVertices));
    vertices_ = *vertices, faces_ = *faces;
    constexpr std::uint64_t kBytesOfVertex = 6;  // at least: "0 0 0\n"
    cloud_.positions.reserve(std::min(vertices_, size_ / kBytesOfVertex));
  }

  void read_vertex(std::uint64_t index) {
    std::string_view line;
    if (!next(line)) throw error(fmt::format("ends after {} of {} vertices", index, vertices_));
    split(line, words_);
    const std::size_t least = layout_.least_numbers(), count = words_.size();
    if (count < least) {
      throw error(fmt::format("expected {} numbers of a vertex, not {}", least, count));
    }
    cloud_.positions.emplace_back(number(words_[0]), number(words_[1]), number(words_[2]));
    std::size_t at = 3;
    if (layout_.normals) {
      cloud_.normals.emplace_back(number(words_[3]), number(words_[4]), number(words_[5]));
      at += 3;
    }
    if (layout_.colours) {
      const bool has_alpha = count > least;
      for (std::size_t c = 0; c < 3; ++c) colours_[c].push_back(number(words_[at++]));
      if (has_alpha) alphas_.push_back(number(words_[at++]));
    }
    if (layout_.texture) at += 2;
    if (at < count) ++vertices_with_more_;
  }

  void read_face(std::uint64_t index) {
    std::string_view line;
    if (!next(line)) throw error(fmt::format("ends after {} of {} faces", index, faces_));
    split(line, words_);
    const auto size = parse_count(words_[0]);
    if (!size || *size >= words_.size()) {
      throw error(
          fmt::format("expected the number of a face's vertices and these, not {:.60}", line));
    }
    for (std::size_t c = 1; c <= *size; ++c) {
      const auto vertex = parse_count(words_[c]);
      if (!vertex || *vertex >= vertices_) {
        throw error(fmt::format("names vertex {:.40} of {}", words_[c], vertices_));
      }
      corners_.push_back(static_cast<std::uint32_t>(*vertex));
    }
    sizes_.push_back(static_cast<std::uint32_t>(*size));
    if (words_.size() > *size + 1) ++faces_with_colours_;
  }

  void warn_of_omissions() {
    const auto warn = [&](std::uint64_t count, const char* what) {
      if (count > 0) loaded_.warnings.push_back(fmt::format("{} {}", count, what));
    };
    warn(layout_.texture ? vertices_ : 0, "texture coordinates are not kept");
    warn(vertices_with_more_, "vertices have more numbers than the keyword announces: not kept");
    warn(faces_with_colours_, "colours of faces are not kept");
    std::uint64_t unread = 0;
    for (std::string_view line; next(line);) ++unread;
    warn(unread, "lines after the last face were not read");
  }

  const std::filesystem::path& path_;
  std::uint64_t size_;
  FileLines lines_;
  std::vector<std::string_view> words_;
  VertexLayout layout_;
  std::uint64_t vertices_ = 0, faces_ = 0;  ///< as declared
  std::array<std::vector<double>, 3> colours_;
  std::vector<double> alphas_;
  std::vector<std::uint32_t> sizes_, corners_;  ///< of the faces
  std::uint64_t vertices_with_more_ = 0, faces_with_colours_ = 0;
  LoadedCloud loaded_;
  PointCloud& cloud_ = loaded_.cloud;
};

}  // namespace

LoadedCloud read_off(const InputFile& file) {
  return OffText(file).read();
}

}  // namespace pcednet::io
