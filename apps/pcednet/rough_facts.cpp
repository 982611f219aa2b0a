#include "rough_facts.h"

#include <algorithm>
#include <string>

#include "pcednet/formats/format.h"
#include "pcednet/io/text_scan.h"

namespace pcednet::app {
namespace {

constexpr std::uint64_t kLookedAt = std::uint64_t{1} << 16;

std::uint64_t points_by_lines(const io::InputFile& file, const std::string& start) {
  const auto lines = static_cast<std::uint64_t>(std::count(start.begin(), start.end(), '\n'));
  return start.empty() ? 0 : file.size() / (start.size() / (lines + 1) + 1);
}

}  // namespace

RoughFacts rough_facts(const io::InputFile& file) {
  const std::string start = file.text(0, kLookedAt);
  const std::string names = io::lower_case(start);
  const bool has_normals =
      names.find("normal_x") != std::string::npos || names.find(" nx") != std::string::npos ||
      names.find(",nx") != std::string::npos || names.find("\nvn ") != std::string::npos;
  const formats::Format& format = formats::format_of(file);
  return {.points = format.points ? format.points(file) : points_by_lines(file, start),
          .has_normals = has_normals};
}

}  // namespace pcednet::app
