#include "pcednet/io/xyz_commas.h"

#include <algorithm>
#include <vector>

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

}  // namespace

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

}  // namespace pcednet::io
