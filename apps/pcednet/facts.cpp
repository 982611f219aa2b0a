#include "facts.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <optional>

#include "pcednet/cloud/bounding_box.h"
#include "pcednet/cloud/class_table.h"

namespace pcednet::app {
namespace {

const char* name_of(ScalarType type) {
  static constexpr std::array kNames = {"int8",   "uint8", "int16",  "uint16",  "int32",
                                        "uint32", "int64", "uint64", "float32", "float64"};
  return kNames[static_cast<std::size_t>(type)];
}

const char* name_of(io::E57Field::Kind kind) {
  static constexpr std::array kNames = {"integer", "scaled integer", "single", "double", "string"};
  return kNames[static_cast<std::size_t>(kind)];
}

constexpr int kMostDecimals = 12;

/// The decimals of a number; none if it has more than kMostDecimals.
std::optional<int> decimals_of(double number) {
  for (int decimals = 0; decimals <= kMostDecimals; ++decimals) {
    const double shifted = number * std::pow(10.0, decimals);
    if (std::abs(shifted - std::round(shifted)) <= 1e-12 * std::abs(shifted)) return decimals;
  }
  return std::nullopt;
}

/// The bounds, in LAS with as many decimals as the file's scale and offset have: 12.34, where the
/// product of integer and scale is 12.340000000000002.
BoundingBox decimal_bounds(const formats::CloudFacts& facts) {
  BoundingBox bounds = facts.bounds;
  if (!facts.las || bounds.empty()) return bounds;
  for (int axis = 0; axis < 3; ++axis) {
    const auto a = static_cast<std::size_t>(axis);
    const auto of_scale = decimals_of(facts.las->scale[a]);
    const auto of_offset = decimals_of(facts.las->offset[a]);
    if (!of_scale || !of_offset) continue;
    const double power = std::pow(10.0, std::max(*of_scale, *of_offset));
    for (Vec3* corner : {&bounds.min, &bounds.max}) {
      (*corner)[axis] = std::round((*corner)[axis] * power) / power;
    }
  }
  return bounds;
}

OrderedJson json_of(const Vec3& v) {
  return {v.x(), v.y(), v.z()};
}

template <typename Value>
OrderedJson json_of(const std::map<Value, std::size_t>& counts) {
  OrderedJson described = OrderedJson::object();
  for (const auto& [value, count] : counts) described[std::to_string(value)] = count;
  return described;
}

OrderedJson json_of(const formats::AttributeFacts& attribute) {
  OrderedJson described = {{"name", attribute.name},
                           {"type", name_of(attribute.type)},
                           {"components", attribute.components}};
  if (attribute.has_numbers()) {
    described["min"] = attribute.least;
    described["max"] = attribute.largest;
  }
  return described;
}

OrderedJson json_of(const io::E57Field& field) {
  OrderedJson described = {{"name", field.name}, {"kind", name_of(field.kind)}};
  if (field.is_integer()) {
    described["bits"] = field.bits();
    described["min"] = field.least;
    described["max"] = field.largest;
  }
  if (field.kind == io::E57Field::Kind::kScaledInteger) {
    described["scale"] = field.scale;
    described["offset"] = field.offset;
  }
  return described;
}

OrderedJson json_of(const io::E57Scan& scan) {
  OrderedJson described = {
      {"name", scan.name}, {"guid", scan.guid}, {"sensor", scan.sensor}, {"points", scan.points}};
  if (scan.has_pose) {
    const Eigen::Quaterniond& q = scan.rotation;
    described["pose"] = {{"rotation_wxyz", {q.w(), q.x(), q.y(), q.z()}},
                         {"translation", json_of(scan.translation)}};
  }
  described["scanner_known"] = scan.knows_scanner();
  described["fields"] = OrderedJson::array();
  for (const io::E57Field& field : scan.fields) described["fields"].push_back(json_of(field));
  return described;
}

OrderedJson json_of(const io::E57Document& document) {
  OrderedJson scans = OrderedJson::array();
  for (const io::E57Scan& scan : document.scans) scans.push_back(json_of(scan));
  return {{"coordinate_system", document.coordinate_system}, {"scans", scans}};
}

OrderedJson json_of(const io::LasFacts& las) {
  OrderedJson records = OrderedJson::array();
  for (const io::LasFacts::Record& record : las.records) {
    records.push_back({{"user_id", record.user_id},
                       {"record_id", record.record_id},
                       {"description", record.description},
                       {"bytes", record.bytes}});
  }
  return {{"version", fmt::format("1.{}", las.minor_version)},
          {"point_format", las.point_format},
          {"compressed", las.compressed},
          {"copc", las.copc},
          {"system", las.system},
          {"software", las.software},
          {"created_day", las.created_day},
          {"created_year", las.created_year},
          {"scale", las.scale},
          {"offset", las.offset},
          {"coordinate_system_code", las.code},
          {"coordinate_system", las.coordinate_system},
          {"records", records},
          {"extra_bytes", las.extra_bytes},
          {"points_by_return", json_of(las.points_by_return)},
          {"points_by_class", json_of(las.points_by_class)}};
}

std::string name_of_class(std::uint8_t label, const ClassTable& table) {
  if (label < table.size()) return table[label].name;
  return label == kUnlabelled ? "unlabelled" : fmt::format("class {}", label);
}

/// As JSON spells it: with a point or an exponent even if the number is whole.
std::string spelled(double number) {
  return to_text(Json(number));
}

template <typename Numbers>
std::string spelled_list(const Numbers& numbers) {
  std::string list;
  for (const double number : numbers) list += (list.empty() ? "" : ",") + spelled(number);
  return "[" + list + "]";
}

std::string plain(const Vec3& v) {
  return fmt::format("{} {} {}", v.x(), v.y(), v.z());
}

/// Collects lines, each with a name and a value.
class Lines {
 public:
  explicit Lines(std::string title) : text_(std::move(title) + "\n") {}
  void add(std::string_view name, const std::string& value) {
    text_ += fmt::format("  {:<14} {}\n", name, value);
  }
  void add_all(std::string_view name, const std::vector<std::string>& values) {
    for (const std::string& value : values) add(name, value);
  }
  std::string take() { return std::move(text_); }

 private:
  std::string text_;
};

std::string text_of(const std::map<std::uint8_t, std::size_t>& labels, const ClassTable& table) {
  std::vector<std::string> parts;
  for (const auto& [label, count] : labels) {
    parts.push_back(fmt::format("{} {} ({})", count, name_of_class(label, table), label));
  }
  return fmt::format("{}", fmt::join(parts, ", "));
}

std::string text_of(const formats::AttributeFacts& attribute) {
  std::string text = fmt::format("{} {}", name_of(attribute.type), attribute.name);
  if (attribute.components > 1) text += fmt::format(" x {}", attribute.components);
  if (!attribute.has_numbers()) return text;
  const bool narrow = attribute.type == ScalarType::kFloat32;
  const auto number = [&](double value) {
    return narrow ? fmt::format("{}", static_cast<float>(value)) : fmt::format("{}", value);
  };
  return text + ", " + number(attribute.least) + " to " + number(attribute.largest);
}

std::string text_of(const Defects& defects, bool in_parts) {
  const std::pair<std::size_t, const char*> counts[] = {
      {defects.positions, "positions not finite"},
      {defects.normals, "normals unusable"},
      {defects.duplicates, in_parts ? "duplicate positions or more" : "duplicate positions"}};
  std::vector<std::string> parts;
  for (const auto& [count, name] : counts) {
    if (count != 0) parts.push_back(fmt::format("{} {}", count, name));
  }
  return parts.empty() ? "none" : fmt::format("{}", fmt::join(parts, ", "));
}

std::string text_of(const io::E57Field& field) {
  std::string text = fmt::format("{} {}", name_of(field.kind), field.name);
  if (field.is_integer()) {
    text += fmt::format(", {} bits, {} to {}", field.bits(), field.least, field.largest);
  }
  if (field.kind == io::E57Field::Kind::kScaledInteger) {
    text += fmt::format(", scale {}, offset {}", spelled(field.scale), spelled(field.offset));
  }
  return text;
}

void add(const io::E57Document& document, Lines& lines) {
  std::size_t index = 0;
  for (const io::E57Scan& scan : document.scans) {
    lines.add(fmt::format("scan {}", index++),
              fmt::format("{}{}, {} points", scan.name,
                          scan.sensor.empty() ? "" : ", " + scan.sensor, scan.points));
    if (scan.has_pose) {
      const Eigen::Quaterniond& q = scan.rotation;
      const std::array<double, 4> rotation = {q.w(), q.x(), q.y(), q.z()};
      lines.add("  pose", fmt::format("moved by {}, turned by {} (w x y z)",
                                      spelled_list(scan.translation), spelled_list(rotation)));
    }
    lines.add("  scanner", scan.knows_scanner() ? "known" : "unknown");
    for (const io::E57Field& field : scan.fields) lines.add("  field", text_of(field));
  }
}

template <typename NameOf>
std::string text_of(const std::map<int, std::size_t>& counts, const NameOf& name_of) {
  std::vector<std::string> parts;
  for (const auto& [value, count] : counts) {
    const std::string_view name = name_of(value);
    parts.push_back(fmt::format("{}{}{}: {}", value, name.empty() ? "" : " ", name, count));
  }
  return fmt::format("{}", fmt::join(parts, ", "));
}

/// The code of the coordinate system and the name that its definition begins with; the definition
/// where there is no code.
std::string system_text(const io::LasFacts& las) {
  const std::string& wkt = las.coordinate_system;
  if (las.code.empty()) return wkt.empty() ? "of no coordinate system that the file names" : wkt;
  const std::size_t begin = wkt.find('"');
  if (begin == std::string::npos) return las.code;
  return fmt::format("{}, {}", las.code,
                     wkt.substr(begin + 1, wkt.find('"', begin + 1) - begin - 1));
}

void add(const io::LasFacts& las, Lines& lines) {
  const auto add_known = [&](const char* name, const std::string& text) {
    if (!text.empty()) lines.add(name, text);
  };
  lines.add("version",
            fmt::format("LAS 1.{}, point format {}{}", las.minor_version, las.point_format,
                        las.copc         ? ", COPC"
                        : las.compressed ? ", LASzip"
                                         : ""));
  const char* const between = las.system.empty() || las.software.empty() ? "" : " / ";
  lines.add("made by", fmt::format("{}{}{}, day {} of {}", las.system, between, las.software,
                                   las.created_day, las.created_year));
  lines.add("scale", spelled_list(las.scale));
  lines.add("offset", spelled_list(las.offset));
  lines.add("coordinates", system_text(las));
  for (const io::LasFacts::Record& record : las.records) {
    lines.add("record",
              fmt::format("{} {}, {} bytes{}{}", record.user_id, record.record_id, record.bytes,
                          record.description.empty() ? "" : ", ", record.description));
  }
  add_known("by return", text_of(las.points_by_return, [](int) { return std::string_view(); }));
  add_known("by class", text_of(las.points_by_class, [&](int code) {
              return io::las_class_name(static_cast<unsigned>(code), las.point_format);
            }));
}

}  // namespace

OrderedJson json_of(const std::filesystem::path& path, const formats::CloudFacts& facts) {
  OrderedJson file = {{"file", path.string()},
                      {"format", facts.format},
                      {"points", facts.points},
                      {"position_type", name_of(facts.position_type)}};
  if (facts.read < facts.points) file["points_read"] = facts.read;
  if (!facts.bounds.empty()) {
    const BoundingBox bounds = decimal_bounds(facts);
    file["bounds"] = {{"min", json_of(bounds.min)}, {"max", json_of(bounds.max)}};
  }
  if (facts.spacing) {
    file["mean_spacing"] = facts.spacing->mean;
    file["median_spacing"] = facts.spacing->median;
    file["spacing"] = facts.spacing->side;
  }
  file["normals"] = facts.has_normals;
  file["colours"] = facts.has_colours;
  if (!facts.labels.empty()) file["labels"] = json_of(facts.labels);
  file["attributes"] = OrderedJson::array();
  for (const auto& attribute : facts.attributes) file["attributes"].push_back(json_of(attribute));
  file["comments"] = facts.comments;
  file["elements"] = facts.elements;
  file["defects"] = {{"positions_not_finite", facts.defects.positions},
                     {"normals_unusable", facts.defects.normals},
                     {"duplicate_positions", facts.defects.duplicates}};
  if (facts.outliers) file["outliers"] = *facts.outliers;
  file["problems"] = facts.problems;
  if (facts.e57) file["e57"] = json_of(*facts.e57);
  if (facts.las) file["las"] = json_of(*facts.las);
  file["warnings"] = facts.warnings;
  return file;
}

std::string text_of(const std::filesystem::path& path, const formats::CloudFacts& facts) {
  Lines lines(path.string());
  lines.add("format", std::string(facts.format));
  lines.add("points", fmt::format("{}", facts.points));
  if (facts.read < facts.points) {
    lines.add("read", fmt::format("{}, a sample: counts and ranges below are of these. --all "
                                  "reads every point",
                                  facts.read));
  }
  lines.add("position type", name_of(facts.position_type));
  if (!facts.bounds.empty()) {
    const BoundingBox bounds = decimal_bounds(facts);
    lines.add("least x y z", plain(bounds.min));
    lines.add("largest x y z", plain(bounds.max));
  }
  if (facts.spacing) {
    lines.add("mean spacing", fmt::format("{:.6g}", facts.spacing->mean));
    lines.add("median spacing", fmt::format("{:.6g}", facts.spacing->median));
    lines.add(
        "spacing",
        fmt::format("{:.6g}, the side of the square that holds one point: the unit of `lines`",
                    facts.spacing->side));
  }
  if (!facts.spacing && facts.read < facts.points) {
    lines.add("spacing", "unknown: parts of the file overlap. --all determines it");
  }
  const std::size_t unusable = facts.defects.normals;
  lines.add("normals", !facts.has_normals ? "no"
                       : unusable == 0    ? "yes, made unit"
                                          : fmt::format("yes, made unit; {} unusable", unusable));
  lines.add("colours", facts.has_colours ? "yes" : "no");
  lines.add("labels",
            facts.labels.empty() ? "no" : text_of(facts.labels, classes_of(facts.comments)));
  for (const auto& attribute : facts.attributes) lines.add("attribute", text_of(attribute));
  lines.add_all("also", facts.elements);
  lines.add_all("comment", facts.comments);
  lines.add("defects", text_of(facts.defects, facts.parts > 0));
  if (facts.parts > 0) {
    lines.add("outliers",
              "not counted: the file is read in parts, as it has more than two million "
              "points");
  }
  lines.add_all("problem", facts.problems);
  if (facts.e57) add(*facts.e57, lines);
  if (facts.las) add(*facts.las, lines);
  lines.add_all("warning", facts.warnings);
  return lines.take();
}

}  // namespace pcednet::app
