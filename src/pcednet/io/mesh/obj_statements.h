#pragma once

#include <cstddef>
#include <filesystem>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "pcednet/core/error.h"
#include "pcednet/core/vec3.h"
#include "pcednet/io/text_scan.h"

namespace pcednet::io {

/// The statements of an OBJ file one after the other, lines that continue with \ joined.
class ObjStatements {
 public:
  /// Both must outlive it.
  ObjStatements(const std::filesystem::path& path, std::string_view text);

  /// Moves to the next statement; false after the last.
  bool next();

  /// Its keyword and arguments.
  const std::vector<std::string_view>& words() const { return statement_; }

  /// The comments passed so far.
  std::vector<std::string>& comments() { return comments_; }

  /// The number of the statement's last line.
  std::size_t line() const { return lines_.number(); }

  /// An Error(kUnreadable) that names the file and line().
  Error error(const std::string& what) const;

  /// The number that an argument spells. Throws error().
  double number(std::size_t word) const;

  /// The three after "v", which w or r g b may follow. Throws error().
  Vec3 vertex() const;

 private:
  const std::filesystem::path& path_;
  Lines lines_;
  std::vector<std::string_view> words_, statement_;
  std::vector<std::string> comments_;
};

/// The position that an index denotes: n is the n-th of the file, -n the n-th last of the `so_far`
/// before it. None if `word` is not such a number.
std::optional<std::size_t> obj_index(std::string_view word, std::size_t so_far);

}  // namespace pcednet::io
