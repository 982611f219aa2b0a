#include "tile_numbers.h"

#include <fmt/format.h>

#include <algorithm>
#include <charconv>
#include <set>
#include <string_view>

#include "pcednet/core/error.h"
#include "pcednet/tiles/join.h"

namespace pcednet::app {
namespace {

/// Adds the numbers of "7" or "0-15".
void add_numbers(const std::string& text, std::size_t tiles, std::set<std::size_t>& numbers) {
  const auto refuse = [&] {
    throw Error(ErrorKind::kUsage, fmt::format("--tile {}: not a tile of 0 to {}, or two with - "
                                               "between them",
                                               text, tiles - 1));
  };
  std::size_t first = 0, last = 0;
  const char* const end = text.data() + text.size();
  auto parsed = std::from_chars(text.data(), end, first);
  if (parsed.ec != std::errc()) refuse();
  last = first;
  if (parsed.ptr != end) {
    if (*parsed.ptr != '-') refuse();
    parsed = std::from_chars(parsed.ptr + 1, end, last);
    if (parsed.ec != std::errc() || parsed.ptr != end) refuse();
  }
  if (last < first || last >= tiles) refuse();
  for (std::size_t id = first; id <= last; ++id) numbers.insert(id);
}

}  // namespace

std::vector<std::size_t> tile_numbers(const std::vector<std::string>& texts, std::size_t tiles) {
  std::set<std::size_t> chosen;
  for (const std::string& text : texts) add_numbers(text, tiles, chosen);
  if (texts.empty()) {
    for (std::size_t id = 0; id < tiles; ++id) chosen.insert(chosen.end(), id);
  }
  return {chosen.begin(), chosen.end()};
}

std::string tile_options(const std::vector<std::size_t>& numbers) {
  std::string text;
  for (const auto& [first, last] : tiles::ranges_of(numbers)) {
    text += fmt::format(" --tile {}", first);
    if (last > first) text += fmt::format("-{}", last);
  }
  return text;
}

std::string shell_word(const std::string& word) {
  constexpr std::string_view kPlain = "_./-+=,:@%";
  const auto is_plain = [&](char c) {
    const bool is_letter = (c >= 'a' && c <= 'z') || (c >= 'A' && c <= 'Z') || (c & 0x80) != 0;
    return is_letter || (c >= '0' && c <= '9') || kPlain.find(c) != std::string_view::npos;
  };
  if (!word.empty() && std::all_of(word.begin(), word.end(), is_plain)) return word;
  std::string quoted = "'";
  for (const char c : word) quoted += c == '\'' ? std::string("'\\''") : std::string(1, c);
  return quoted + "'";
}

}  // namespace pcednet::app
