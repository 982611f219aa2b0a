#include "pcednet/io/coordinate_system.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cctype>
#include <limits>
#include <optional>
#include <vector>

#include "pcednet/io/length_units.h"
#include "pcednet/io/text_scan.h"

namespace pcednet::io {
namespace {

/// A node of a definition: KEYWORD["text", number, NODE[...], ...].
struct WktNode {
  std::string keyword;                   ///< in lower case
  std::vector<std::string_view> values;  ///< texts without their quotes
};

/// Calls `visit(ancestors)`, the outermost first, for every node as it closes.
template <typename Visit>
void visit_wkt(std::string_view wkt, Visit&& visit) {
  std::vector<WktNode> open;
  std::size_t word = 0;
  const auto take_word = [&](std::size_t end) {
    const std::string_view value = trim(wkt.substr(word, end - word));
    if (!value.empty() && !open.empty()) open.back().values.push_back(value);
  };
  for (std::size_t i = 0; i < wkt.size(); ++i) {
    const char c = wkt[i];
    if (c == '"') {
      const std::size_t end = std::min(wkt.find('"', i + 1), wkt.size());
      if (!open.empty()) open.back().values.push_back(wkt.substr(i + 1, end - i - 1));
      i = end;
    } else if (c == '[' || c == '(') {
      open.push_back({lower_case(trim(wkt.substr(word, i - word))), {}});
    } else if (c == ']' || c == ')') {
      if (open.empty()) return;
      take_word(i);
      visit(open);
      open.pop_back();
    } else if (c != ',') {
      continue;
    } else {
      take_word(i);
    }
    word = i + 1;
  }
}

bool is_one_of(std::string_view word, std::initializer_list<std::string_view> words) {
  return std::find(words.begin(), words.end(), word) != words.end();
}

/// The keywords of systems that a definition may describe, in both versions.
constexpr std::array<std::string_view, 15> kSystemKeywords = {
    "projcs",        "projcrs",  "projectedcrs", "geogcs",         "geogcrs",
    "geographiccrs", "geodcrs",  "geodeticcrs",  "geoccs",         "compd_cs",
    "compoundcrs",   "local_cs", "engcrs",       "engineeringcrs", "boundcrs"};

bool is_of_heights(std::string_view keyword) {
  return is_one_of(keyword, {"vert_cs", "vertcrs", "verticalcrs"});
}

/// Whether the innermost node is the system itself or the horizontal part of a compound one.
bool is_horizontal(const std::vector<WktNode>& open) {
  return open.size() == 1 ||
         (open.size() == 2 && is_one_of(open[0].keyword, {"compd_cs", "compoundcrs"}));
}

int epsg_of(const WktNode& node) {
  if (!is_one_of(node.keyword, {"authority", "id"})) return 0;
  if (node.values.size() < 2 || lower_case(node.values[0]) != "epsg") return 0;
  return epsg_code(node.values[1]);
}

}  // namespace

int epsg_code(std::string_view word) {
  const auto code = parse_count(word);
  return code && *code <= std::numeric_limits<int>::max() ? static_cast<int>(*code) : 0;
}

std::string code_text(const CoordinateSystem& system) {
  if (system.epsg <= 0) return {};
  return fmt::format("EPSG:{}{}", system.epsg,
                     system.vertical_epsg > 0 ? fmt::format("+{}", system.vertical_epsg) : "");
}

CoordinateSystem coordinate_system_of_wkt(std::string_view wkt) {
  CoordinateSystem system{.epsg = 0, .wkt = std::string(trim(wkt))};
  int whole = 0, horizontal = 0, heights = 0;
  bool heights_alone = false;
  bool cartesian = false;  // as geocentric systems are, which share a keyword with geographic ones
  std::optional<LengthUnit> common;  // of all lengths so far
  double least = 0.0, most = 0.0;    // metres of their units
  visit_wkt(wkt, [&](const std::vector<WktNode>& open) {
    const WktNode& node = open.back();
    const std::string_view parent = open.size() > 1 ? std::string_view(open.end()[-2].keyword) : "";
    if (const int code = epsg_of(node)) {
      if (open.size() == 2) whole = code;
      const bool of_part = is_one_of(parent, {"projcs", "projcrs", "geogcs", "geogcrs", "geodcrs"});
      const bool in_compound =
          open.size() == 3 && is_one_of(open[0].keyword, {"compd_cs", "compoundcrs"});
      if (in_compound && of_part) horizontal = code;
      if (in_compound && is_of_heights(parent)) heights = code;
    }
    if (open.size() == 1 && is_of_heights(node.keyword)) heights_alone = true;
    if (is_horizontal(open) && is_one_of(node.keyword, {"geogcs", "geogcrs", "geodcrs"})) {
      system.geographic = !cartesian;
    }
    cartesian = cartesian || (node.keyword == "cs" && !node.values.empty() &&
                              lower_case(node.values[0]) == "cartesian");
    // An ellipsoid and the parameters of a projection may have other units than the coordinates.
    const bool is_length =
        (node.keyword == "lengthunit" && !is_one_of(parent, {"ellipsoid", "parameter"})) ||
        (node.keyword == "unit" &&
         is_one_of(parent, {"projcs", "vert_cs", "vertcs", "geoccs", "local_cs"}));
    if (!is_length || node.values.size() < 2) return;
    const double metres = parse_double(node.values[1]).value_or(0.0);
    least = most > 0.0 ? std::min(least, metres) : metres;
    most = std::max(most, metres);
    const LengthUnit unit = unit_of_metres(metres);
    common = common.value_or(unit) == unit ? unit : LengthUnit::kNone;
  });
  if (heights_alone) {
    system.vertical_epsg = whole;
    return system;
  }
  system.epsg = whole ? whole : horizontal;
  if (!whole) system.vertical_epsg = heights;
  // Degrees are no lengths, though heights above them are.
  if (system.geographic) return system;
  system.unit = common.value_or(LengthUnit::kNone);
  system.stretched = is_stretched(least, most);
  return system;
}

bool is_stretched(double a, double b) {
  constexpr double kMost = 1.001;  // the US survey foot and the foot are one here
  return std::min(a, b) > 0.0 && std::max(a, b) > kMost * std::min(a, b);
}

std::string heights_in(std::string_view wkt) {
  std::string text;
  for (const char c : wkt) {
    const auto byte = static_cast<unsigned char>(c);
    if (!std::isspace(byte)) text += static_cast<char>(std::toupper(byte));
  }
  std::size_t begin = std::string::npos;
  for (const char* keyword : {"VERT_CS[", "VERTCS[", "VERTCRS[", "VERTICALCRS["}) {
    begin = std::min(begin, text.find(keyword));
  }
  return begin == std::string::npos ? "" : text.substr(begin);
}

std::string wkt_of_comments(const std::vector<std::string>& comments) {
  for (const std::string& comment : comments) {
    if (!comment.starts_with(kSystemComment)) continue;
    const std::string_view wkt = trim(std::string_view(comment).substr(kSystemComment.size()));
    const std::string keyword = lower_case(trim(wkt.substr(0, wkt.find_first_of("[("))));
    const auto* const end = kSystemKeywords.end();
    const bool is_system = std::find(kSystemKeywords.begin(), end, keyword) != end;
    if (is_system && keyword.size() < wkt.size()) return std::string(wkt);
  }
  return {};
}

}  // namespace pcednet::io
