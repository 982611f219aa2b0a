#pragma once

#include <string_view>

namespace pcednet::io {

/// The meaning of the commas in a line of numbers.
enum class Commas { kNone, kSeparators, kDecimals, kUnclear };

/// Commas are decimal beside semicolons (1,5;2,5), and within three or more words of at most one
/// each (1,5 2,25 3). They separate numbers in a line without blanks, next to a blank (1, 2 ,3),
/// and where a word has two (1,2,3 255). Unclear are lines that read either way, such as 1,5, 2,5,
/// 3,5 or 1,5 2 or 1.234,5 1,0 2,0.
Commas commas_of(std::string_view line);

}  // namespace pcednet::io
