#include "pcednet/io/column_names.h"

#include <fmt/format.h>

#include <charconv>
#include <cstring>
#include <optional>
#include <utility>
#include <vector>

namespace pcednet::io {
namespace {

/// The character that "%XX" at the start of `text` encodes, if there is one.
std::optional<char> decoded(std::string_view text) {
  if (text.size() < 3 || text[0] != '%') return std::nullopt;
  unsigned code = 0;
  const auto [end, fault] = std::from_chars(text.data() + 1, text.data() + 3, code, 16);
  if (fault != std::errc{} || end != text.data() + 3) return std::nullopt;
  return static_cast<char>(code);
}

std::string encoded(char c) {
  return fmt::format("%{:02X}", static_cast<unsigned char>(c));
}

bool ends_a_word(char c) {
  const auto code = static_cast<unsigned char>(c);
  return code <= ' ' || code == 127 || c == ',' || c == ';' || c == '"';
}

/// Where the ending of a half begins; "_" alone is padding in PCD.
std::size_t special_underscore(std::string_view name) {
  for (const std::string_view ending : {kLowHalf, kHighHalf}) {
    if (name.ends_with(ending)) return name.size() - ending.size();
  }
  return name == "_" ? 0 : std::string_view::npos;
}

bool are_halves(const Attribute& low, const Attribute& high) {
  const bool fit = low.type == ScalarType::kUint32 && low.components == 1 &&
                   (high.type == ScalarType::kUint32 || high.type == ScalarType::kInt32) &&
                   high.components == 1 && low.name.ends_with(kLowHalf);
  return fit &&
         high.name == low.name.substr(0, low.name.size() - kLowHalf.size()).append(kHighHalf);
}

Attribute joined(const Attribute& low, const Attribute& high) {
  Attribute whole{low.name.substr(0, low.name.size() - kLowHalf.size()),
                  high.type == ScalarType::kInt32 ? ScalarType::kInt64 : ScalarType::kUint64, 1,
                  std::vector<std::byte>(2 * low.bytes.size())};
  for (std::size_t at = 0; at < low.bytes.size(); at += 4) {
    std::memcpy(&whole.bytes[2 * at], &low.bytes[at], 4);
    std::memcpy(&whole.bytes[2 * at + 4], &high.bytes[at], 4);
  }
  return whole;
}

}  // namespace

std::string percent_decoded(std::string_view text) {
  std::string plain;
  while (!text.empty()) {
    const auto character = decoded(text);
    plain += character.value_or(text[0]);
    text.remove_prefix(character ? 3 : 1);
  }
  return plain;
}

std::string column_name(std::string_view name) {
  const std::size_t underscore = special_underscore(name);
  std::string column;
  for (std::size_t i = 0; i < name.size(); ++i) {
    const bool keep = i != underscore && !ends_a_word(name[i]) && !decoded(name.substr(i));
    column += keep ? std::string(1, name[i]) : encoded(name[i]);
  }
  return column.empty() ? "unnamed" : column;
}

std::string hidden(std::string column) {
  std::size_t plain = 0;
  while (decoded(std::string_view(column).substr(plain))) plain += 3;
  if (plain == column.size()) return column + '_';
  return column.replace(plain, 1, encoded(column[plain]));
}

void restore_attributes(PointCloud& cloud) {
  std::vector<Attribute> restored;
  auto& given = cloud.attributes;
  for (std::size_t a = 0; a < given.size(); ++a) {
    const bool halves = a + 1 < given.size() && are_halves(given[a], given[a + 1]);
    restored.push_back(halves ? joined(given[a], given[a + 1]) : std::move(given[a]));
    restored.back().name = percent_decoded(restored.back().name);
    if (halves) ++a;
  }
  given = std::move(restored);
}

}  // namespace pcednet::io
