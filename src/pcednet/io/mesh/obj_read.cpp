#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <iterator>
#include <utility>

#include "pcednet/io/mesh/obj.h"
#include "pcednet/io/mesh/obj_statements.h"
#include "pcednet/io/ply/faces.h"
#include "pcednet/io/promote.h"

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

/// Their number, and the line of the first.
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
  std::vector<std::uint32_t> line_ends;  ///< of their segments, two after two
  std::size_t others = 0;                ///< points, and lines of one vertex
  std::vector<std::string> comments;
};

class StatementParser {
 public:
  StatementParser(const std::filesystem::path& path, std::string_view text)
      : statements_(path, text) {}

  Statements parse() {
    while (statements_.next()) {
      const std::string_view keyword = statements_.words()[0];
      if (keyword == "v") {
        take_vertex();
      } else if (keyword == "vn") {
        take_normal();
      } else if (keyword == "f" || keyword == "l" || keyword == "p") {
        take_element(keyword);
      }
    }
    result_.comments = std::move(statements_.comments());
    return std::move(result_);
  }

 private:
  void take_vertex() {
    result_.positions.push_back(statements_.vertex());
    const std::size_t count = statements_.words().size() - 1;
    if (count == 4) statements_.number(4);
    if (count != 6) return;
    for (std::size_t c = 0; c < 3; ++c) result_.colours[c].push_back(statements_.number(4 + c));
  }

  void take_normal() {
    if (statements_.words().size() != 4) throw statements_.error("expected vn x y z");
    result_.normals.emplace_back(statements_.number(1), statements_.number(2),
                                 statements_.number(3));
  }

  void take_element(std::string_view keyword) {
    const auto& words = statements_.words();
    corners_.clear();
    for (std::size_t w = 1; w < words.size(); ++w) {
      corners_.push_back(static_cast<std::uint32_t>(take_corner(words[w])));
    }
    if (keyword == "f") {
      result_.face_sizes.push_back(static_cast<std::uint32_t>(corners_.size()));
      std::copy(corners_.begin(), corners_.end(), std::back_inserter(result_.face_corners));
    } else if (keyword == "l" && corners_.size() > 1) {
      for (std::size_t c = 1; c < corners_.size(); ++c) {
        result_.line_ends.insert(result_.line_ends.end(), {corners_[c - 1], corners_[c]});
      }
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
    if (const auto normal = obj_index(corner.substr(second + 1), result_.normals.size())) {
      result_.corners.push_back({vertex, *normal, statements_.line()});
    } else {
      result_.corners_without_normal.add(statements_.line());
    }
    return vertex;
  }

  std::size_t vertex_index(std::string_view word) {
    const auto found = obj_index(word, result_.positions.size());
    if (!found) throw statements_.error(fmt::format("expected the index of a v, not {:.40}", word));
    FarthestIndex& farthest = result_.farthest_vertex;
    if (*found >= farthest.end) farthest = {*found + 1, statements_.line()};
    return *found;
  }

  ObjStatements statements_;
  std::vector<std::uint32_t> corners_;  ///< of the statement
  Statements result_;
};

void check_vertices(const std::filesystem::path& path, const Statements& statements) {
  const FarthestIndex& farthest = statements.farthest_vertex;
  const std::size_t count = statements.positions.size();
  if (farthest.end <= count) return;
  throw unreadable(path, fmt::format("names v number {} of {}", farthest.end, count),
                   farthest.line);
}

/// A corner may name a normal that the file lacks.
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
  Statements statements = StatementParser(file.path(), text).parse();
  check_vertices(file.path(), statements);
  LoadedCloud loaded;
  drop_corners_without_normal(statements, loaded.warnings);
  PointCloud& cloud = loaded.cloud;
  cloud.normals = normals_of_vertices(statements, loaded.warnings);
  cloud.positions = std::move(statements.positions);
  cloud.comments = std::move(statements.comments);
  const std::size_t coloured = statements.colours[0].size();
  if (coloured == cloud.size() && coloured > 0) {
    add_colours(statements.colours, cloud, loaded.warnings);
  } else if (coloured > 0) {
    loaded.warnings.push_back(
        fmt::format("colours of {} of {} points are not kept", coloured, cloud.size()));
  }
  if (!statements.face_sizes.empty()) {
    cloud.foreign_elements = {make_face_element(statements.face_sizes, statements.face_corners)};
  }
  if (!statements.line_ends.empty()) {
    cloud.foreign_elements.push_back(make_edge_element(statements.line_ends));
  }
  if (statements.others > 0) {
    loaded.warnings.push_back(fmt::format("{} points (p) are not kept", statements.others));
  }
  return loaded;
}

}  // namespace pcednet::io
