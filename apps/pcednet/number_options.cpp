#include "number_options.h"

#include <fmt/format.h>

#include <algorithm>
#include <charconv>
#include <cmath>
#include <limits>

namespace pcednet::app {
namespace {

constexpr std::uint64_t kLargest = std::numeric_limits<std::uint64_t>::max();

bool is_any(std::uint64_t least, std::uint64_t most) {
  return least == 0 && most == kLargest;
}

/// Checks that a word is a sign, or none, and decimal digits; takes away zeros in front.
CLI::Validator decimal_digits() {
  CLI::Validator check("");
  check.operation([](std::string& word) -> std::string {
    const std::size_t begin = word.starts_with('-') ? 1 : 0;
    const bool sound =
        begin < word.size() && word.find_first_not_of("0123456789", begin) == std::string::npos;
    if (!sound) return word + " is not a whole number";
    word.erase(begin, std::min(word.find_first_not_of('0', begin), word.size() - 1) - begin);
    return "";
  });
  return check;
}

}  // namespace

CLI::Validator number(const std::string& meaning, const std::function<bool(double)>& is_sound) {
  return {[=](const std::string& word) -> std::string {
            double value = 0.0;
            const bool sound =
                CLI::detail::lexical_cast(word, value) && std::isfinite(value) && is_sound(value);
            return sound ? "" : fmt::format("{} is not {}", word, meaning);
          },
          meaning};
}

CLI::Validator number_from_0() {
  return number("a number, 0 or more", [](double v) { return v >= 0.0; });
}

CLI::Validator number_above_0() {
  return number("a number above 0", [](double v) { return v > 0.0; });
}

CLI::Validator length_above_0() {
  return number("a length above 0, at most 1e150", [](double v) { return v > 0.0 && v <= 1e150; });
}

CLI::Validator share() {
  return number("a number from 0 to 1", [](double v) { return v >= 0.0 && v <= 1.0; });
}

CLI::Validator whole_number(std::uint64_t least, std::uint64_t most) {
  CLI::Validator check(is_any(least, most) ? "" : fmt::format("{} to {}", least, most));
  check.operation([=](std::string& word) -> std::string {
    std::uint64_t value = 0;
    const char* const end = word.data() + word.size();
    const auto [stop, error] = std::from_chars(word.data(), end, value);
    if (error != std::errc() || stop != end || value < least || value > most) {
      return fmt::format("{} is not a whole number from {} to {}", word, least, most);
    }
    word = std::to_string(value);
    return "";
  });
  return check;
}

void guard_number_options(CLI::App& app) {
  for (CLI::Option* option : app.get_options()) {
    const std::string type = option->get_type_name();
    if (type == "UINT") option->transform(whole_number(0, kLargest));
    if (type.starts_with("INT")) option->transform(decimal_digits());
  }
  for (CLI::App* command : app.get_subcommands({})) guard_number_options(*command);
}

}  // namespace pcednet::app
