#include <fmt/format.h>
#include <fmt/ranges.h>

#include <array>

#include "decimal_bounds.h"
#include "facts.h"
#include "pcednet/cloud/class_table.h"

namespace pcednet::app {
namespace {

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

/// Those that mean the same in all versions of LAS, and high noise, which means nothing else.
const std::map<int, const char*> kLasClasses = {
    {0, " never classified"}, {1, " unassigned"},        {2, " ground"},
    {3, " low vegetation"},   {4, " medium vegetation"}, {5, " high vegetation"},
    {6, " building"},         {7, " low noise"},         {9, " water"},
    {18, " high noise"}};

std::string text_of(const std::map<int, std::size_t>& counts,
                    const std::map<int, const char*>& names) {
  std::vector<std::string> parts;
  for (const auto& [value, count] : counts) {
    const auto name = names.find(value);
    parts.push_back(fmt::format("{}{}: {}", value, name == names.end() ? "" : name->second, count));
  }
  return fmt::format("{}", fmt::join(parts, ", "));
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
  lines.add("made by", fmt::format("{} / {}, day {} of {}", las.system, las.software,
                                   las.created_day, las.created_year));
  lines.add("scale", spelled_list(las.scale));
  lines.add("offset", spelled_list(las.offset));
  add_known("coordinates", las.coordinate_system);
  for (const io::LasFacts::Record& record : las.records) {
    lines.add("record", fmt::format("{} {}, {} bytes, {}", record.user_id, record.record_id,
                                    record.bytes, record.description));
  }
  add_known("by return", text_of(las.points_by_return, {}));
  add_known("by class", text_of(las.points_by_class, kLasClasses));
}

}  // namespace

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
