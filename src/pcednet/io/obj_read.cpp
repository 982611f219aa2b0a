#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <charconv>
#include <cmath>
#include <optional>
#include <utility>

#include "pcednet/io/faces.h"
#include "pcednet/io/obj.h"
#include "pcednet/io/promote.h"
#include "pcednet/io/text_scan.h"

namespace pcednet::io {
namespace {

/// A vertex and a normal that a face puts together.
struct Corner {
  std::size_t vertex = 0;
  std::size_t normal = 0;
  std::size_t line = 0;
};

/// The largest index used, and where.
struct FarthestIndex {
  std::size_t end = 0;  ///< index + 1
  std::size_t line = 0;
};

/// How many there are, and where the first is.
struct Ignored {
  std::size_t count = 0;
  std::size_t line = 0;

  void add(std::size_t at) { line = count++ == 0 ? at : std::min(line, at); }
};

/// The statements of an OBJ file that concern points.
struct Statements {
  std::vector<Vec3> positions;
  std::vector<Vec3> normals;
  std::array<std::vector<double>, 3> colours;
  std::vector<Corner> corners;
  FarthestIndex farthest_vertex;
  Ignored corners_without_normal;  ///< whose index of a normal is none
  std::vector<std::uint32_t> face_sizes, face_corners;
  std::size_t others = 0;  ///< lines and points
  std::vector<std::string> comments;
};

class StatementParser {
 public:
  explicit StatementParser(const std::filesystem::path& path) : path_(path) {}

  Statements parse(std::string_view text) {
    Lines lines(text);
    std::string_view line;
    while (lines.next(line)) {
      number_ = lines.number();
      line = trim(line);
      if (line.starts_with('#')) {
        result_.comments.emplace_back(trim(line.substr(1)));
        continue;
      }
      const bool continues = line.ends_with('\\');
      if (continues) line.remove_suffix(1);
      split(line, words_);
      statement_.insert(statement_.end(), words_.begin(), words_.end());
      if (!continues) take_statement();
    }
    take_statement();
    return std::move(result_);
  }

 private:
  Error error(const std::string& what) const { return unreadable(path_, what, number_); }

  void take_statement() {
    const std::string_view keyword = statement_.empty() ? "" : statement_[0];
    if (keyword == "v") {
      take_vertex();
    } else if (keyword == "vn") {
      if (statement_.size() != 4) throw error("expected vn x y z");
      result_.normals.emplace_back(number(1), number(2), number(3));
    } else if (keyword == "f" || keyword == "l" || keyword == "p") {
      take_face(keyword == "f");
    }
    statement_.clear();
  }

  double number(std::size_t word) const {
    const auto value = parse_double(statement_[word]);
    if (!value) throw error(number_fault(statement_[word]));
    return *value;
  }

  void take_vertex() {
    const std::size_t count = statement_.size() - 1;
    if (count != 3 && count != 4 && count != 6) {
      throw error(fmt::format("v with {} numbers; expected x y z, x y z w or x y z r g b", count));
    }
    result_.positions.emplace_back(number(1), number(2), number(3));
    if (count == 4) number(4);
    if (count != 6) return;
    for (std::size_t c = 0; c < 3; ++c) result_.colours[c].push_back(number(4 + c));
  }

  void take_face(bool keep) {
    for (std::size_t w = 1; w < statement_.size(); ++w) {
      const std::size_t vertex = take_corner(statement_[w]);
      if (keep) result_.face_corners.push_back(static_cast<std::uint32_t>(vertex));
    }
    if (keep) {
      result_.face_sizes.push_back(static_cast<std::uint32_t>(statement_.size() - 1));
    } else {
      ++result_.others;
    }
  }

  /// Returns the index of the corner's vertex.
  std::size_t take_corner(std::string_view corner) {
    const std::size_t first = corner.find('/');
    const std::size_t vertex = vertex_index(corner.substr(0, first));
    if (first == std::string_view::npos) return vertex;
    const std::size_t second = corner.find('/', first + 1);
    if (second == std::string_view::npos || second + 1 == corner.size()) return vertex;
    if (const auto normal = index(corner.substr(second + 1), result_.normals.size())) {
      result_.corners.push_back({vertex, *normal, number_});
    } else {
      result_.corners_without_normal.add(number_);
    }
    return vertex;
  }

  std::size_t vertex_index(std::string_view word) {
    const auto found = index(word, result_.positions.size());
    if (!found) throw error(fmt::format("expected the index of a v, not {:.40}", word));
    FarthestIndex& farthest = result_.farthest_vertex;
    if (*found >= farthest.end) farthest = {*found + 1, number_};
    return *found;
  }

  /// What an index means: n is the n-th of the file, -n the n-th last of the `so_far` before it.
  static std::optional<std::size_t> index(std::string_view word, std::size_t so_far) {
    std::int64_t value = 0;
    const auto [end, fault] = std::from_chars(word.data(), word.data() + word.size(), value);
    const bool is_number = fault == std::errc{} && end == word.data() + word.size();
    const bool is_before = value < 0 && static_cast<std::uint64_t>(-(value + 1)) < so_far;
    if (!is_number || !(value > 0 || is_before)) return std::nullopt;
    return value > 0 ? static_cast<std::size_t>(value - 1)
                     : so_far - static_cast<std::size_t>(-value);
  }

  const std::filesystem::path& path_;
  std::size_t number_ = 0;
  std::vector<std::string_view> words_;
  std::vector<std::string_view> statement_;  ///< keyword and arguments
  Statements result_;
};

void check_vertices(const std::filesystem::path& path, const Statements& statements) {
  const FarthestIndex& farthest = statements.farthest_vertex;
  const std::size_t count = statements.positions.size();
  if (farthest.end <= count) return;
  throw unreadable(path, fmt::format("names v number {} of {}", farthest.end, count),
                   farthest.line);
}

/// A corner may name a normal that the file has not.
void drop_corners_without_normal(Statements& statements, std::vector<std::string>& warnings) {
  Ignored& ignored = statements.corners_without_normal;
  std::erase_if(statements.corners, [&](const Corner& corner) {
    const bool exists = corner.normal < statements.normals.size();
    if (!exists) ignored.add(corner.line);
    return !exists;
  });
  if (ignored.count == 0) return;
  warnings.push_back(fmt::format(
      "{} corners of faces name none of the {} normals, the first in line {}: read without normal",
      ignored.count, statements.normals.size(), ignored.line));
}

std::vector<Vec3> normals_of_vertices(const Statements& statements,
                                      std::vector<std::string>& warnings) {
  const std::size_t points = statements.positions.size();
  if (!statements.corners.empty()) {
    std::vector<Vec3> sums(points, Vec3::Zero());
    for (const Corner& corner : statements.corners) {
      const Vec3& normal = statements.normals[corner.normal];
      const double length = normal.stableNorm();
      if (length > 0.0 && std::isfinite(length)) sums[corner.vertex] += normal / length;
    }
    return sums;
  }
  if (statements.normals.size() == points) return statements.normals;
  if (!statements.normals.empty()) {
    warnings.push_back(
        fmt::format("{} normals for {} points are not kept", statements.normals.size(), points));
  }
  return {};
}

}  // namespace

LoadedCloud read_obj(const InputFile& file) {
  const std::string text = file.text();
  Statements statements = StatementParser(file.path()).parse(text);
  check_vertices(file.path(), statements);
  LoadedCloud loaded;
  drop_corners_without_normal(statements, loaded.warnings);
  PointCloud& cloud = loaded.cloud;
  cloud.normals = normals_of_vertices(statements, loaded.warnings);
  cloud.positions = std::move(statements.positions);
  cloud.comments = std::move(statements.comments);
  const std::size_t coloured = statements.colours[0].size();
  if (coloured == cloud.size() && coloured > 0) {
    cloud.attributes = {make_attribute("red", statements.colours[0]),
                        make_attribute("green", statements.colours[1]),
                        make_attribute("blue", statements.colours[2])};
    promote_colours(cloud, loaded.warnings);
  } else if (coloured > 0) {
    loaded.warnings.push_back(
        fmt::format("colours of {} of {} points are not kept", coloured, cloud.size()));
  }
  if (!statements.face_sizes.empty()) {
    cloud.foreign_elements = {make_face_element(statements.face_sizes, statements.face_corners)};
  }
  if (statements.others > 0) {
    loaded.warnings.push_back(fmt::format("{} lines or points are not kept", statements.others));
  }
  return loaded;
}

}  // namespace pcednet::io
