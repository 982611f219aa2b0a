#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "pcednet/cloud/attribute.h"

namespace pcednet::io {

/// The lines of a text, ended by \n, \r\n or (in a text without \n) \r; the last may lack its end.
class Lines {
 public:
  explicit Lines(std::string_view text, std::size_t lines_before = 0);

  /// Moves to the next line and puts it, without its end, in `line`; false after the last.
  bool next(std::string_view& line);
  /// The same to the next line that is not blank.
  bool next_filled(std::string_view& line);
  /// Moves to the next line that is not blank; gives the number of bytes from there to the end.
  std::size_t unread();

  /// Number of the line that next() gave last, counted from 1 (plus `lines_before`).
  std::size_t number() const { return number_; }

 private:
  std::string_view rest_;
  std::size_t number_;
  char end_;
};

/// The lines of all texts, in order; an empty text has none.
std::vector<std::string_view> split_lines(std::span<const std::string> texts);

inline constexpr std::string_view kBlanks = " \t\r\v\f";

std::string_view trim(std::string_view text);

/// A set of characters with fast lookup.
class Separators {
 public:
  constexpr explicit Separators(std::string_view characters) {
    for (const char c : characters) is_in_[static_cast<unsigned char>(c)] = true;
  }
  constexpr bool operator()(char c) const { return is_in_[static_cast<unsigned char>(c)]; }

 private:
  std::array<bool, 256> is_in_ = {};
};
inline constexpr Separators kBlankSeparators{kBlanks};

/// The separators between the numbers of a text, except for decimal commas.
inline constexpr Separators kNumberSeparators{" \t\r\v\f,;"};

/// Whether a line of a text of points or labels begins with # or //.
bool is_comment(std::string_view line);

/// `text` behind its byte-order mark, if it has that of UTF-8.
std::string_view without_mark(std::string_view text);

/// Whether `text` begins with a byte-order mark of UTF-16.
bool is_utf16(std::string_view text);

/// A text in UTF-8: `text` itself, unless it has a byte-order mark of UTF-16. Halves of characters
/// become U+FFFD.
std::string in_utf8(std::string text);

/// Replaces `fields` by the parts of `line` between runs of separators.
void split(std::string_view line, std::vector<std::string_view>& fields,
           const Separators& separators = kBlankSeparators);

/// The double nearest to what `token` spells; none if that is too large. "nan" and "inf" count.
std::optional<double> parse_double(std::string_view token);

/// The reason why parse_double() returns none.
std::string number_fault(std::string_view token);

/// A whole number without sign.
std::optional<std::uint64_t> parse_count(std::string_view token);

/// Stores the number that `token` spells at `number`, in `type`. False, with nothing stored, if it
/// spells none or one that the type does not hold.
bool parse_number(std::string_view token, ScalarType type, std::byte* number);

/// ASCII letters in lower case.
std::string lower_case(std::string_view text);

/// The extension of a file in lower case, with its dot: ".ply".
std::string extension_of(const std::filesystem::path& path);

}  // namespace pcednet::io
