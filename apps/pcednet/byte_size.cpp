#include "byte_size.h"

#include <fmt/format.h>

#include <algorithm>
#include <charconv>
#include <cmath>

#include "pcednet/core/error.h"

namespace pcednet::app {

std::uint64_t byte_size(const std::string& option, const std::string& text) {
  double number = 0.0;
  const char* const end = text.data() + text.size();
  const auto [rest, error] = std::from_chars(text.data(), end, number);
  std::string letters(rest, end);  // 2, 2G, 2GB and 2GiB are all powers of 1024
  for (char& letter : letters) letter = static_cast<char>(letter | 0x20);
  const std::size_t power = letters.empty() ? 0 : std::string("bkmgt").find(letters[0]);
  const std::string after = letters.substr(std::min<std::size_t>(letters.size(), 1));
  const bool is_known = power != std::string::npos &&
                        (after.empty() || (power > 0 && (after == "b" || after == "ib")));
  const double unit = is_known ? std::pow(1024.0, static_cast<double>(power)) : 0.0;
  const double bytes = number * unit;
  if (error == std::errc() && letters.empty() && bytes > 0.0 && bytes < 0x1p20) {
    throw Error(ErrorKind::kUsage,
                fmt::format("{} {}: is a number of bytes: write the unit, such as {}G or {}M",
                            option, text, text, text));
  }
  if (error == std::errc() && bytes >= 1.0 && bytes < 1e18)
    return static_cast<std::uint64_t>(bytes);
  throw Error(ErrorKind::kUsage, fmt::format("{} {}: not a size such as 500M or 2G", option, text));
}

std::string size_text(std::uint64_t bytes) {
  const auto b = static_cast<double>(bytes);
  return b < 0x1p30 ? fmt::format("{:.0f} MiB", std::ceil(b / 0x1p20))
                    : fmt::format("{:.1f} GiB", b / 0x1p30);
}

}  // namespace pcednet::app
