#include "pcednet/io/mesh/obj_statements.h"

#include <fmt/format.h>

#include <charconv>
#include <cstdint>

#include "pcednet/core/counted.h"
#include "pcednet/io/input_file.h"

namespace pcednet::io {

ObjStatements::ObjStatements(const std::filesystem::path& path, std::string_view text)
    : path_(path), lines_(text) {}

bool ObjStatements::next() {
  statement_.clear();
  std::string_view line;
  while (lines_.next(line)) {
    line = trim(line);
    if (line.starts_with('#')) {
      comments_.emplace_back(trim(line.substr(1)));
      continue;
    }
    const bool continues = line.ends_with('\\');
    if (continues) line.remove_suffix(1);
    split(line, words_);
    statement_.insert(statement_.end(), words_.begin(), words_.end());
    if (!continues && !statement_.empty()) return true;
  }
  return !statement_.empty();
}

Error ObjStatements::error(const std::string& what) const {
  return unreadable(path_, what, line());
}

double ObjStatements::number(std::size_t word) const {
  const auto value = parse_double(statement_[word]);
  if (!value) throw error(number_fault(statement_[word]));
  return *value;
}

Vec3 ObjStatements::vertex() const {
  const std::size_t count = statement_.size() - 1;
  if (count != 3 && count != 4 && count != 6) {
    throw error(
        fmt::format("v with {}; expected x y z, x y z w or x y z r g b", counted(count, "number")));
  }
  return {number(1), number(2), number(3)};
}

std::optional<std::size_t> obj_index(std::string_view word, std::size_t so_far) {
  std::int64_t value = 0;
  const auto [end, fault] = std::from_chars(word.data(), word.data() + word.size(), value);
  const bool is_number = fault == std::errc{} && end == word.data() + word.size();
  const bool is_before = value < 0 && static_cast<std::uint64_t>(-(value + 1)) < so_far;
  if (!is_number || !(value > 0 || is_before)) return std::nullopt;
  return value > 0 ? static_cast<std::size_t>(value - 1)
                   : so_far - static_cast<std::size_t>(-value);
}

}  // namespace pcednet::io
