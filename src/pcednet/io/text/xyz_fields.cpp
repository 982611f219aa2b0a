#include "pcednet/io/text/xyz_fields.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <span>
#include <vector>

#include "pcednet/io/promote.h"
#include "pcednet/io/text_scan.h"

namespace pcednet::io {
namespace {

bool has_outer_comma(std::string_view word) {
  return word.starts_with(',') || word.ends_with(',');
}

std::ptrdiff_t inner_commas(std::string_view word) {
  while (word.starts_with(',')) word.remove_prefix(1);
  while (word.ends_with(',')) word.remove_suffix(1);
  return std::count(word.begin(), word.end(), ',');
}

// In the order of preference.
constexpr std::string_view kEastings[] = {"easting", "east", "rechtswert"};
constexpr std::string_view kNorthings[] = {"northing", "north", "hochwert"};
/// Höhe in UTF-8 and in Latin-1, with the capital that lower_case() leaves.
constexpr std::string_view kHeights[] = {"z",       "elevation",   "elev",        "altitude",
                                         "height",  "h\xC3\xB6he", "h\xC3\x96he", "h\xF6he",
                                         "h\xD6he", "hoehe"};

constexpr std::string_view kUnits[] = {"m",  "metre", "metres", "meter", "meters",
                                       "mm", "cm",    "km",     "ft",    "feet"};

/// The name in small letters, without a unit of length in brackets: x of "X [m]".
std::string plain_name(const std::string& name) {
  std::string plain = lower_case(name);
  const std::size_t open = plain.find_first_of("[(");
  if (open == std::string::npos || plain.find_first_of("])", open) + 1 != plain.size())
    return plain;
  const std::string_view unit =
      trim(std::string_view(plain).substr(open + 1, plain.size() - open - 2));
  if (std::ranges::count(kUnits, unit) == 0) return plain;
  return std::string(trim(std::string_view(plain).substr(0, open)));
}

/// Where the word is a name, in any case; names.size() if it is none.
std::size_t find_name(const std::vector<std::string>& names, std::string_view word) {
  const auto found = std::find_if(names.begin(), names.end(), [&](const std::string& name) {
    return plain_name(name) == word;
  });
  return static_cast<std::size_t>(found - names.begin());
}

/// The same for the first of the words that is one.
std::size_t find_first(const std::vector<std::string>& names,
                       std::span<const std::string_view> words) {
  for (const std::string_view word : words) {
    const std::size_t found = find_name(names, word);
    if (found < names.size()) return found;
  }
  return names.size();
}

}  // namespace

void split_fields(std::string_view line, const Separators& separators,
                  std::vector<std::string_view>& fields) {
  fields.clear();
  bool is_due = true;  // a field, since the last separator or the beginning
  std::size_t at = 0;
  while (at < line.size()) {
    const std::size_t begin = at;
    while (at < line.size() && !separators(line[at]) && !kBlankSeparators(line[at])) ++at;
    if (at > begin) {
      fields.push_back(line.substr(begin, at - begin));
      is_due = false;
      continue;
    }
    if (separators(line[at++])) {
      if (is_due) fields.emplace_back();
      is_due = true;
    }
  }
  if (is_due && !line.empty()) fields.emplace_back();
}

Commas commas_of(std::string_view line) {
  const auto has = [line](char c) { return line.find(c) != std::string_view::npos; };
  if (!has(',')) return Commas::kNone;
  if (has(';')) return Commas::kDecimals;
  std::vector<std::string_view> words;
  split(line, words);
  const auto has_two = [](auto word) { return inner_commas(word) > 1; };
  const auto has_one = [](auto word) { return inner_commas(word) == 1; };
  if (words.size() == 1 || std::any_of(words.begin(), words.end(), has_two)) {
    return Commas::kSeparators;
  }
  if (std::any_of(words.begin(), words.end(), has_outer_comma)) {
    const bool may_be_decimal = !has('.') && std::all_of(words.begin(), words.end(), has_one);
    return may_be_decimal ? Commas::kUnclear : Commas::kSeparators;
  }
  return words.size() > 2 && !has('.') ? Commas::kDecimals : Commas::kUnclear;
}

std::vector<std::string> split_names(std::string_view line) {
  std::vector<std::string> names;
  const std::size_t separator = line.find_first_of(";,\t");
  if (separator == std::string_view::npos) {
    std::vector<std::string_view> words;
    split(line, words);
    names.assign(words.begin(), words.end());
  } else {
    const char mark = line[separator];
    for (std::size_t begin = 0; begin <= line.size();) {
      const std::size_t end = std::min(line.find(mark, begin), line.size());
      names.emplace_back(trim(line.substr(begin, end - begin)));
      begin = end + 1;
    }
  }
  for (std::string& name : names) std::erase(name, '"');
  return names;
}

bool name_positions(std::vector<std::string>& names) {
  const std::size_t none = names.size();
  std::array found = {find_name(names, "x"), find_name(names, "y"), find_name(names, "z")};
  if (found[0] == none && found[1] == none) {
    found = {find_first(names, kEastings), find_first(names, kNorthings),
             find_first(names, kHeights)};
  }
  if (found == std::array{none, none, none}) {
    found = {find_name(names, "e"), find_name(names, "n"), find_name(names, "h")};
  }
  if (std::count(found.begin(), found.end(), none) > 0) return false;
  for (std::size_t axis = 0; axis < 3; ++axis) names[found[axis]] = std::string(1, "xyz"[axis]);
  return true;
}

bool looks_like_normal(const double* n) {
  const double length = std::hypot(n[0], n[1], n[2]);
  return length > 0.9 && length < 1.1;
}

void TableFacts::add(std::span<const double> row) {
  columns_.resize(row.size());
  if (rows_++ == 0) next_ = std::floor(row[0]);
  counts_ = counts_ && row[0] == next_++;
  for (std::size_t c = 0; c < row.size(); ++c) {
    Column& column = columns_[c];
    const double value = row[c];
    const bool is_byte = value >= 0.0 && value <= 255.0 && value == std::floor(value);
    column.are_up_to_one = column.are_up_to_one && !(value > 1.0);
    column.are_bytes = column.are_bytes && is_byte;
    column.are_labels = column.are_labels && (is_byte || to_label(value));
    column.are_classes = column.are_classes && is_byte && (value <= 2.0 || value == 255.0);
    column.unit += c + 3 <= row.size() && looks_like_normal(&row[c]);
  }
}

bool TableFacts::are_normals(std::size_t first) const {
  return columns_[first].unit > 0 && 10 * columns_[first].unit >= 9 * rows_;
}

std::vector<std::string> guess_column_names(const TableFacts& facts, TextKind kind) {
  std::vector<std::string> names = {"x", "y", "z"};
  const auto are_colours = [&](std::size_t first) {
    return facts.are_bytes(first) && facts.are_bytes(first + 1) && facts.are_bytes(first + 2);
  };
  bool has_normals = false, has_colours = false;
  while (names.size() < facts.columns()) {
    const std::size_t next = names.size();
    const std::size_t left = facts.columns() - next;
    // x y z intensity r g b, the usual .pts: four columns of which three are colours either way.
    const bool is_counted = kind == TextKind::kCountedPts;
    const bool may_be_label = !is_counted && facts.are_classes(facts.columns() - 1);
    const bool scalar_first = left == 4 && are_colours(next + 1) && !may_be_label;
    const bool is_alone = left == 1 && !may_be_label;
    if (kind != TextKind::kAny && next == 3 && (scalar_first || is_alone)) {
      names.emplace_back("intensity");
    } else if (left >= 3 && !has_normals && facts.are_normals(next)) {
      names.insert(names.end(), {"nx", "ny", "nz"});
      has_normals = true;
    } else if (left >= 3 && !has_colours && !scalar_first && are_colours(next)) {
      names.insert(names.end(), {"red", "green", "blue"});
      has_colours = true;
    } else if (left == 1 && facts.are_classes(next)) {
      names.emplace_back("label");
    } else {
      names.push_back(fmt::format("scalar_{}", next + 1));
    }
  }
  return names;
}

}  // namespace pcednet::io
