#include "byte_size.h"

#include <fmt/format.h>

#include <charconv>
#include <cmath>

#include "pcednet/core/error.h"

namespace pcednet::app {

std::uint64_t byte_size(const std::string& option, const std::string& text) {
  double number = 0.0;
  const char* const end = text.data() + text.size();
  const auto [rest, error] = std::from_chars(text.data(), end, number);
  double unit = 0.0;
  if (rest == end) unit = 1.0;
  if (rest + 1 == end) {
    const std::size_t power = std::string("kmgt").find(static_cast<char>(*rest | 0x20));
    if (power != std::string::npos) unit = std::pow(1024.0, static_cast<double>(power + 1));
  }
  const double bytes = number * unit;
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
