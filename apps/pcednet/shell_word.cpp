#include "shell_word.h"

#include <algorithm>
#include <string_view>

namespace pcednet::app {

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
