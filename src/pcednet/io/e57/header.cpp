#include "pcednet/io/e57/header.h"

#include <fmt/format.h>

#include <algorithm>
#include <bit>
#include <charconv>
#include <cmath>
#include <pugixml.hpp>

#include "pcednet/io/text_scan.h"

namespace pcednet::io {
namespace {

/// Reads numbers and names out of the XML, and knows which file to blame.
class Parser {
 public:
  explicit Parser(const InputFile& file) : file_(file) {}

  Error error(const std::string& what) const { return unreadable(file_.path(), "XML: " + what); }

  /// The number that `text` spells; `otherwise` if there is none.
  template <typename Number>
  Number number(std::string_view text, Number otherwise, const char* what) const {
    text = trim(text);
    if (text.starts_with('+')) text.remove_prefix(1);
    if (text.empty()) return otherwise;
    Number value = {};
    const auto [end, code] = std::from_chars(text.data(), text.data() + text.size(), value);
    if (code != std::errc() || end != text.data() + text.size()) {
      throw error(fmt::format("{} is not a valid number: {:.40}", what, text));
    }
    return value;
  }

  /// The number in an element, 0 in an empty one or if there is none.
  double real(const pugi::xml_node& parent, const char* name) const {
    const double value = number(parent.child_value(name), 0.0, name);
    if (!std::isfinite(value)) throw error(fmt::format("{} is not finite", name));
    return value;
  }

  E57Scan scan(const pugi::xml_node& node) const;

 private:
  E57Field field(const pugi::xml_node& node) const;
  void pose(const pugi::xml_node& node, E57Scan& scan) const;
  std::optional<E57Limits> limits(const pugi::xml_node& node, const std::string& channel) const;

  const InputFile& file_;
};

std::string one_line(const char* text) {
  std::string line(trim(text));
  std::replace_if(
      line.begin(), line.end(), [](char c) { return c == '\n' || c == '\r' || c == '\t'; }, ' ');
  return line;
}

E57Field Parser::field(const pugi::xml_node& node) const {
  using Kind = E57Field::Kind;
  E57Field field;
  field.name = node.name();
  const std::string_view type = node.attribute("type").value();
  const auto real = [&](const char* name, double otherwise) {
    return number(node.attribute(name).value(), otherwise, name);
  };
  if (type == "Integer" || type == "ScaledInteger") {
    field.kind = type == "Integer" ? Kind::kInteger : Kind::kScaledInteger;
    field.least = number(node.attribute("minimum").value(), field.least, "minimum");
    field.largest = number(node.attribute("maximum").value(), field.largest, "maximum");
    if (field.kind == Kind::kScaledInteger) {
      field.scale = real("scale", 1.0);
      field.offset = real("offset", 0.0);
    }
    if (field.least > field.largest) {
      throw error(fmt::format("{}: the least value, {}, is above the largest, {}", field.name,
                              field.least, field.largest));
    }
  } else if (type == "Float") {
    const std::string_view precision = node.attribute("precision").value();
    field.kind = precision == "single" ? Kind::kSingle : Kind::kDouble;
    if (node.attribute("minimum")) field.lower = real("minimum", 0.0);
    if (node.attribute("maximum")) field.upper = real("maximum", 0.0);
  } else if (type == "String") {
    field.kind = Kind::kString;
  } else {
    throw error(fmt::format("points with {:.40} of the unknown type {:.40}", field.name, type));
  }
  return field;
}

void Parser::pose(const pugi::xml_node& node, E57Scan& scan) const {
  scan.has_pose = static_cast<bool>(node);
  if (const pugi::xml_node t = node.child("translation")) {
    scan.translation = {real(t, "x"), real(t, "y"), real(t, "z")};
  }
  if (const pugi::xml_node r = node.child("rotation")) {
    Eigen::Quaterniond q(real(r, "w"), real(r, "x"), real(r, "y"), real(r, "z"));
    const double length = q.norm();
    if (!(std::abs(length - 1.0) < 1e-2)) {
      throw error(fmt::format("the rotation of a pose has length {} instead of 1", length));
    }
    scan.rotation = q.normalized();
  }
}

std::optional<E57Limits> Parser::limits(const pugi::xml_node& node,
                                        const std::string& channel) const {
  const std::string lower = channel + "Minimum", upper = channel + "Maximum";
  if (!node.child(lower.c_str()) || !node.child(upper.c_str())) return std::nullopt;
  return E57Limits{real(node, lower.c_str()), real(node, upper.c_str())};
}

E57Scan Parser::scan(const pugi::xml_node& node) const {
  E57Scan scan;
  scan.name = one_line(node.child_value("name"));
  scan.guid = one_line(node.child_value("guid"));
  for (const char* part : {"sensorVendor", "sensorModel", "sensorSerialNumber"}) {
    const std::string text = one_line(node.child_value(part));
    if (!text.empty()) scan.sensor += (scan.sensor.empty() ? "" : " ") + text;
  }
  pose(node.child("pose"), scan);
  for (const char* channel : {"colorRed", "colorGreen", "colorBlue"}) {
    scan.colour_limits.push_back(limits(node.child("colorLimits"), channel));
  }
  const pugi::xml_node points = node.child("points");
  const auto whole = [&](const char* name) {
    return number(points.attribute(name).value(), std::uint64_t{0}, name);
  };
  scan.points = whole("recordCount");
  scan.points_offset = whole("fileOffset");
  for (const pugi::xml_node& child : points.child("prototype").children()) {
    if (child.type() != pugi::node_element) continue;
    scan.fields.push_back(field(child));
    const auto& last = scan.fields.back();
    for (std::size_t f = 0; f + 1 < scan.fields.size(); ++f) {
      if (scan.fields[f].name == last.name) throw error("points have two fields " + last.name);
    }
  }
  return scan;
}

}  // namespace

unsigned E57Field::bits() const {
  if (kind == Kind::kSingle) return 32;
  if (kind == Kind::kString) return 0;
  if (!is_integer()) return 64;
  return static_cast<unsigned>(
      std::bit_width(static_cast<std::uint64_t>(largest) - static_cast<std::uint64_t>(least)));
}

ScalarType E57Field::type() const {
  if (kind == Kind::kSingle) return ScalarType::kFloat32;
  if (kind != Kind::kInteger) return ScalarType::kFloat64;
  const auto fits = [&](auto zero) {
    using Limits = std::numeric_limits<decltype(zero)>;
    return least >= static_cast<std::int64_t>(Limits::min()) &&
           largest <= static_cast<std::int64_t>(Limits::max());
  };
  if (fits(std::uint8_t{})) return ScalarType::kUint8;
  if (fits(std::int8_t{})) return ScalarType::kInt8;
  if (fits(std::uint16_t{})) return ScalarType::kUint16;
  if (fits(std::int16_t{})) return ScalarType::kInt16;
  if (fits(std::uint32_t{})) return ScalarType::kUint32;
  if (fits(std::int32_t{})) return ScalarType::kInt32;
  return ScalarType::kInt64;
}

bool E57Scan::moves() const {
  return !translation.isZero(0.0) || !rotation.vec().isZero(0.0);
}

bool E57Scan::knows_scanner() const {
  return moves() || find_field(*this, "sphericalRange") != nullptr ||
         (find_field(*this, "rowIndex") != nullptr && find_field(*this, "columnIndex") != nullptr);
}

std::string_view local_name(std::string_view name) {
  return name.substr(name.find(':') + 1);
}

const E57Field* find_field(const E57Scan& scan, std::string_view name) {
  const auto found = std::find_if(scan.fields.begin(), scan.fields.end(), [&](const E57Field& f) {
    return f.is_number() && local_name(f.name) == name;
  });
  return found == scan.fields.end() ? nullptr : &*found;
}

E57Document read_e57_document(const E57Pages& pages) {
  const E57Header& header = pages.header();
  const Parser parser(pages.file());
  const std::uint64_t begin = pages.logical(header.xml_offset, "the XML");
  if (header.xml_bytes > pages.size() - begin) {
    throw parser.error(fmt::format("{} bytes declared at byte {}, but only {} follow",
                                   header.xml_bytes, header.xml_offset, pages.size() - begin));
  }
  std::vector<std::byte> text(header.xml_bytes);
  pages.read(begin, text);
  pugi::xml_document xml;
  const pugi::xml_parse_result parsed = xml.load_buffer(text.data(), text.size());
  if (!parsed) throw parser.error(fmt::format("byte {}: {}", parsed.offset, parsed.description()));
  const pugi::xml_node root = xml.child("e57Root");
  if (!root) throw parser.error("no element e57Root");

  E57Document document;
  document.coordinate_system = one_line(root.child_value("coordinateMetadata"));
  for (const pugi::xml_node& child : root.child("data3D").children()) {
    if (child.type() == pugi::node_element) document.scans.push_back(parser.scan(child));
  }
  return document;
}

}  // namespace pcednet::io
