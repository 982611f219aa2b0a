#include "pcednet/io/text_scan.h"

#include <fmt/format.h>

#include <algorithm>
#include <charconv>
#include <cmath>
#include <cstring>
#include <limits>
#include <type_traits>

namespace pcednet::io {
namespace {

std::string_view without_plus(std::string_view token) {
  if (token.size() > 1 && token[0] == '+' && token[1] != '-') token.remove_prefix(1);
  return token;
}

/// from_chars over the whole token.
template <typename T>
std::errc parse_all(std::string_view token, T& value) {
  const auto [end, error] = std::from_chars(token.data(), token.data() + token.size(), value);
  if (error == std::errc{} && end != token.data() + token.size())
    return std::errc::invalid_argument;
  return error;
}

template <typename T>
bool parse_as(std::string_view token, T& value) {
  const std::errc error = parse_all(token, value);
  if (error == std::errc{}) return true;
  if constexpr (std::is_same_v<T, double>) {
    // from_chars does not distinguish too small from too large.
    const bool is_tiny = error == std::errc::result_out_of_range &&
                         token.find_first_of("eE") + 1 == token.find('-', 1);
    if (is_tiny) value = 0.0;
    return is_tiny;
  } else {
    // An integer written as 1.0, or a number too small for a float.
    double wide = 0.0;
    if (!parse_as(token, wide)) return false;
    if constexpr (std::is_same_v<T, float>) {
      if (std::abs(wide) > std::numeric_limits<float>::max()) return false;
    } else {
      if (!is_in_range<T>(wide) || wide != std::floor(wide)) return false;
    }
    value = static_cast<T>(wide);
    return true;
  }
}

void append_utf8(char32_t code, std::string& text) {
  const auto add = [&](char32_t bits) { text += static_cast<char>(bits); };
  const auto add_tail = [&](int shift) { add(0x80 | (code >> shift & 0x3F)); };
  if (code < 0x80) {
    add(code);
  } else if (code < 0x800) {
    add(0xC0 | code >> 6), add_tail(0);
  } else if (code < 0x10000) {
    add(0xE0 | code >> 12), add_tail(6), add_tail(0);
  } else {
    add(0xF0 | code >> 18), add_tail(12), add_tail(6), add_tail(0);
  }
}

}  // namespace

Lines::Lines(std::string_view text, std::size_t lines_before)
    : rest_(text),
      number_(lines_before),
      end_(text.find('\n') == std::string_view::npos && text.find('\r') != std::string_view::npos
               ? '\r'
               : '\n') {}

bool Lines::next(std::string_view& line) {
  if (rest_.empty()) return false;
  const std::size_t end = rest_.find(end_);
  line = rest_.substr(0, end);
  rest_.remove_prefix(end == std::string_view::npos ? rest_.size() : end + 1);
  if (!line.empty() && line.back() == '\r') line.remove_suffix(1);
  ++number_;
  return true;
}

bool Lines::next_filled(std::string_view& line) {
  while (next(line)) {
    if (!trim(line).empty()) return true;
  }
  return false;
}

std::size_t Lines::unread() {
  std::string_view line;
  const char* const end = rest_.data() + rest_.size();
  return next_filled(line) ? static_cast<std::size_t>(end - line.data()) : 0;
}

std::vector<std::string_view> split_lines(std::span<const std::string> texts) {
  std::vector<std::string_view> all;
  for (const std::string& text : texts) {
    Lines lines(text);
    std::string_view line;
    while (lines.next(line)) all.push_back(line);
  }
  return all;
}

bool is_comment(std::string_view line) {
  return line.starts_with('#') || line.starts_with("//");
}

std::string_view without_mark(std::string_view text) {
  return text.starts_with("\xEF\xBB\xBF") ? text.substr(3) : text;
}

bool is_utf16(std::string_view text) {
  return text.starts_with("\xFF\xFE") || text.starts_with("\xFE\xFF");
}

std::string in_utf8(std::string text) {
  if (!is_utf16(text)) return text;
  const bool little = text.starts_with("\xFF\xFE");
  const auto unit_at = [&](std::size_t at) -> char32_t {
    if (at + 1 >= text.size()) return 0;
    const auto first = static_cast<unsigned char>(text[at]),
               second = static_cast<unsigned char>(text[at + 1]);
    return static_cast<char32_t>(little ? first | second << 8 : first << 8 | second);
  };
  std::string utf8;
  utf8.reserve(text.size() / 2);
  for (std::size_t at = 2; at + 1 < text.size(); at += 2) {
    char32_t code = unit_at(at);
    if (code >= 0xD800 && code < 0xE000) {
      const char32_t next = unit_at(at + 2);
      const bool is_pair = code < 0xDC00 && next >= 0xDC00 && next < 0xE000;
      code = is_pair ? 0x10000 + ((code - 0xD800) << 10) + (next - 0xDC00) : 0xFFFD;
      if (is_pair) at += 2;
    }
    append_utf8(code, utf8);
  }
  return utf8;
}

std::string_view trim(std::string_view text) {
  const std::size_t begin = text.find_first_not_of(kBlanks);
  if (begin == std::string_view::npos) return {};
  return text.substr(begin, text.find_last_not_of(kBlanks) - begin + 1);
}

void split(std::string_view line, std::vector<std::string_view>& fields,
           const Separators& separators) {
  fields.clear();
  for (std::size_t i = 0; i < line.size();) {
    while (i < line.size() && separators(line[i])) ++i;
    const std::size_t begin = i;
    while (i < line.size() && !separators(line[i])) ++i;
    if (i > begin) fields.push_back(line.substr(begin, i - begin));
  }
}

std::optional<double> parse_double(std::string_view token) {
  double value = 0.0;
  if (!parse_as(without_plus(token), value)) return std::nullopt;
  return value;
}

std::string number_fault(std::string_view token) {
  double value = 0.0;
  if (parse_all(without_plus(token), value) == std::errc::result_out_of_range) {
    return fmt::format("{:.40} is beyond the largest double", token);
  }
  return fmt::format("expected a number, not {:.40}", token);
}

std::optional<std::uint64_t> parse_count(std::string_view token) {
  std::uint64_t value = 0;
  if (parse_all(token, value) != std::errc{}) return std::nullopt;
  return value;
}

bool parse_number(std::string_view token, ScalarType type, std::byte* number) {
  return visit_scalar(type, [&](auto value) {
    if (!parse_as(without_plus(token), value)) return false;
    std::memcpy(number, &value, sizeof value);
    return true;
  });
}

std::string extension_of(const std::filesystem::path& path) {
  return lower_case(path.extension().string());
}

std::string lower_case(std::string_view text) {
  std::string lower(text);
  std::transform(lower.begin(), lower.end(), lower.begin(), [](char c) {
    return c >= 'A' && c <= 'Z' ? static_cast<char>(c - 'A' + 'a') : c;
  });
  return lower;
}

}  // namespace pcednet::io
