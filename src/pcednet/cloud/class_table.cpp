#include "pcednet/cloud/class_table.h"

#include <fmt/format.h>

#include <algorithm>
#include <charconv>

#include "pcednet/core/error.h"

namespace pcednet {
namespace {

constexpr std::size_t kLongestName = 40;  // characters
constexpr std::string_view kEdges = "edges";

// Of similar lightness, distinct from the colours of edges and from unlabelled grey.
constexpr std::array<Rgb, kMostClasses> kUsualColours = {{{89, 161, 79},
                                                          {176, 122, 161},
                                                          {242, 142, 43},
                                                          {78, 121, 167},
                                                          {237, 201, 72},
                                                          {118, 183, 178},
                                                          {225, 87, 89},
                                                          {156, 117, 95}}};

[[noreturn]] void refuse(const std::string& why) {
  throw Error(ErrorKind::kUsage, "classes: " + why);
}

/// The number of characters; none unless the text is UTF-8, as JSON takes it.
std::optional<std::size_t> characters_of(std::string_view text) {
  const auto byte = [&](std::size_t i) { return static_cast<unsigned char>(text[i]); };
  std::size_t characters = 0;
  for (std::size_t i = 0; i < text.size(); ++characters) {
    const unsigned char lead = byte(i);
    const std::size_t length = lead < 0x80                    ? 1
                               : lead >= 0xc2 && lead <= 0xdf ? 2
                               : lead >= 0xe0 && lead <= 0xef ? 3
                               : lead >= 0xf0 && lead <= 0xf4 ? 4
                                                              : 0;
    if (length == 0 || i + length > text.size()) return std::nullopt;
    for (std::size_t k = 1; k < length; ++k) {
      if ((byte(i + k) & 0xc0) != 0x80) return std::nullopt;
    }
    // Longer than needed, halves of UTF-16, and beyond U+10FFFF.
    const bool is_none =
        (lead == 0xe0 && byte(i + 1) < 0xa0) || (lead == 0xed && byte(i + 1) >= 0xa0) ||
        (lead == 0xf0 && byte(i + 1) < 0x90) || (lead == 0xf4 && byte(i + 1) >= 0x90);
    if (is_none) return std::nullopt;
    i += length;
  }
  return characters;
}

std::string_view trimmed(std::string_view text) {
  const std::size_t first = text.find_first_not_of(" \t\r");
  if (first == std::string_view::npos) return {};
  return text.substr(first, text.find_last_not_of(" \t\r") - first + 1);
}

/// Adds the class that `text` describes; its number to `plain` if that gives no colour.
void add_class(std::string_view text, ClassTable& table, std::vector<std::size_t>& plain) {
  if (table.empty() && text == kEdges) {
    table = edge_classes();
    return;
  }
  const std::size_t sign = text.rfind('=');
  PointClass one{std::string(trimmed(text.substr(0, sign))), {}};
  if (sign == std::string_view::npos) {
    plain.push_back(table.size());
  } else {
    const auto colour = colour_of(trimmed(text.substr(sign + 1)));
    if (!colour) refuse(fmt::format("\"{}\": a colour is #rrggbb", text));
    one.colour = *colour;
  }
  table.push_back(std::move(one));
}

/// Gives the class its usual colour, or the next that no other class has.
void give_colour(std::size_t id, ClassTable& table) {
  const auto is_taken = [&](const Rgb& colour) {
    return std::any_of(table.begin(), table.end(),
                       [&](const PointClass& other) { return other.colour == colour; });
  };
  std::size_t usual = id;
  while (is_taken(usual_colour(usual)) && usual < id + kUsualColours.size()) ++usual;
  table[id].colour = usual_colour(usual);
}

}  // namespace

const ClassTable& edge_classes() {
  static const ClassTable table = [] {
    ClassTable edges;
    for (const auto& [edge_class, name, colour] : kEdgeClasses) {
      edges.push_back({std::string(name), colour});
    }
    return edges;
  }();
  return table;
}

bool has_edges(const ClassTable& table) {
  const ClassTable& edges = edge_classes();
  return table.size() >= edges.size() && std::equal(edges.begin(), edges.end(), table.begin());
}

bool has_own_classes(const ClassTable& table) {
  return table != edge_classes();
}

std::string text_of(const Rgb& colour) {
  return fmt::format("#{:02x}{:02x}{:02x}", colour[0], colour[1], colour[2]);
}

std::optional<Rgb> colour_of(std::string_view text) {
  if (text.size() != 7 || text[0] != '#') return std::nullopt;
  Rgb colour;
  for (std::size_t k = 0; k < colour.size(); ++k) {
    const char* const first = text.data() + 1 + 2 * k;
    const auto [stop, error] = std::from_chars(first, first + 2, colour[k], 16);
    if (error != std::errc() || stop != first + 2) return std::nullopt;
  }
  return colour;
}

Rgb usual_colour(std::size_t id) {
  return kUsualColours[id % kUsualColours.size()];
}

void check_classes(const ClassTable& table) {
  if (table.size() < 2 || table.size() > kMostClasses) {
    refuse(fmt::format("{} given, 2 to {} are allowed", table.size(), kMostClasses));
  }
  for (auto one = table.begin(); one != table.end(); ++one) {
    const std::string& name = one->name;
    const auto characters = characters_of(name);
    const bool is_plain =
        std::none_of(name.begin(), name.end(), [](unsigned char c) { return c < ' ' || c == 127; });
    if (!characters || *characters < 1 || *characters > kLongestName || !is_plain ||
        trimmed(name).size() != name.size()) {
      refuse(fmt::format("a name has 1 to {} characters", kLongestName));
    }
    const auto same = [&](const PointClass& other) { return other.name == name; };
    if (std::find_if(table.begin(), one, same) != one)
      refuse(fmt::format("\"{}\" is there twice", name));
  }
}

ClassTable parse_classes(std::string_view text) {
  ClassTable table;
  std::vector<std::size_t> plain;
  while (!text.empty()) {
    const std::size_t end = std::min(text.find_first_of(",\n"), text.size());
    const std::string_view one = trimmed(text.substr(0, end));
    const bool is_line = end < text.size() && text[end] == '\n';
    if (!one.empty() || !(is_line || end == text.size())) add_class(one, table, plain);
    text.remove_prefix(std::min(end + 1, text.size()));
  }
  for (const std::size_t id : plain) give_colour(id, table);
  check_classes(table);
  return table;
}

std::string names_of(const ClassTable& table) {
  std::string names;
  const bool edges = has_edges(table);
  if (edges) names = kEdges;
  for (std::size_t id = edges ? kEdgeClasses.size() : 0; id < table.size(); ++id) {
    names += (names.empty() ? "" : ", ") + table[id].name;
  }
  return names;
}

std::vector<std::string> lines_of(const ClassTable& table, std::string_view before) {
  std::vector<std::string> lines;
  for (std::size_t id = 0; id < table.size(); ++id) {
    lines.push_back(
        fmt::format("{}{} {} {}", before, id, text_of(table[id].colour), table[id].name));
  }
  return lines;
}

std::optional<ClassTable> table_of(const std::vector<std::string>& lines, std::string_view before) {
  ClassTable table;
  for (const std::string& line : lines) {
    if (!line.starts_with(before)) continue;
    const std::string id = fmt::format("{}{} ", before, table.size());
    if (!line.starts_with(id) || line.size() < id.size() + 9) return std::nullopt;
    const auto colour = colour_of(std::string_view(line).substr(id.size(), 7));
    if (!colour || line[id.size() + 7] != ' ') return std::nullopt;
    table.push_back({line.substr(id.size() + 8), *colour});
  }
  try {
    check_classes(table);
  } catch (const Error&) {
    return std::nullopt;
  }
  return table;
}

ClassTable classes_of(const std::vector<std::string>& comments) {
  return table_of(comments, kClassComment).value_or(edge_classes());
}

}  // namespace pcednet
