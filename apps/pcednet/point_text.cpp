#include "point_text.h"

#include <algorithm>
#include <string>
#include <string_view>
#include <vector>

#include "pcednet/io/input_file.h"
#include "pcednet/io/text_scan.h"

namespace pcednet::app {
namespace {

using Words = std::vector<std::string_view>;

constexpr std::uint64_t kSeen = 1 << 16;
constexpr io::Separators kSeparators(" \t\r\v\f,;\"");

bool are_numbers(const Words& words) {
  return words.size() >= 3 && std::all_of(words.begin(), words.begin() + 3, [](const auto& word) {
           return io::parse_double(word).has_value();
         });
}

bool name_positions(const Words& words) {
  const auto has = [&](const char* axis) {
    return std::any_of(words.begin(), words.end(),
                       [&](const auto& word) { return io::lower_case(word) == axis; });
  };
  return has("x") && has("y") && has("z");
}

}  // namespace

bool begins_like_points(const std::filesystem::path& path) {
  const io::InputFile file(path);
  const std::string text = file.text(0, kSeen);
  const bool is_whole = file.size() <= kSeen;
  std::string_view seen = text;
  if (seen.starts_with("\xEF\xBB\xBF")) seen.remove_prefix(3);
  if (!is_whole) seen = seen.substr(0, seen.find_last_of("\r\n") + 1);
  io::Lines lines(seen);
  std::string_view line;
  Words words;
  bool named = false, counted = false;
  while (lines.next(line)) {
    line = io::trim(line);
    if (line.empty() || line.starts_with('#') || line.starts_with("//")) continue;
    io::split(line, words, kSeparators);
    if (are_numbers(words)) return true;
    const bool is_count = !counted && !named && words.size() == 1 && io::parse_count(words[0]);
    const bool is_names = !named && name_positions(words);
    if (!is_count && !is_names) return false;
    counted = counted || is_count;
    named = named || is_names;
  }
  return named || !is_whole;
}

}  // namespace pcednet::app
