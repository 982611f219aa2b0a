#include "pcednet/io/xyz_names.h"

#include <algorithm>
#include <array>
#include <span>

#include "pcednet/io/text_scan.h"

namespace pcednet::io {
namespace {

// In the order of preference.
constexpr std::string_view kEastings[] = {"easting", "rechtswert"};
constexpr std::string_view kNorthings[] = {"northing", "hochwert"};
/// Höhe in UTF-8 and in Latin-1, with the capital that lower_case() leaves.
constexpr std::string_view kHeights[] = {"z",       "elevation",   "altitude",
                                         "height",  "h\xC3\xB6he", "h\xC3\x96he",
                                         "h\xF6he", "h\xD6he",     "hoehe"};

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

}  // namespace pcednet::io
