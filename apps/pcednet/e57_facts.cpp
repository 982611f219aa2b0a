#include "e57_facts.h"

#include <fmt/format.h>

#include <array>
#include <cstdio>
#include <string>

#include "pcednet/io/e57/header.h"

namespace pcednet::app {
namespace {

using nlohmann::ordered_json;

ordered_json describe(const io::E57Field& field) {
  static constexpr std::array kKinds = {"integer", "scaled integer", "single", "double", "string"};
  ordered_json described = {{"name", field.name},
                            {"kind", kKinds[static_cast<std::size_t>(field.kind)]}};
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

ordered_json describe(const io::E57Scan& scan) {
  ordered_json described = {
      {"name", scan.name}, {"guid", scan.guid}, {"sensor", scan.sensor}, {"points", scan.points}};
  if (scan.has_pose) {
    const Eigen::Quaterniond& q = scan.rotation;
    const Vec3& t = scan.translation;
    described["pose"] = {{"rotation_wxyz", {q.w(), q.x(), q.y(), q.z()}},
                         {"translation", {t.x(), t.y(), t.z()}}};
  }
  described["scanner_known"] = scan.knows_scanner();
  described["fields"] = ordered_json::array();
  for (const io::E57Field& field : scan.fields) described["fields"].push_back(describe(field));
  return described;
}

void print_field(const ordered_json& field) {
  std::string text =
      fmt::format("{} {}", field["kind"].get<std::string>(), field["name"].get<std::string>());
  if (field.contains("bits")) {
    text += fmt::format(", {} bits, {} to {}", field["bits"].get<unsigned>(),
                        field["min"].get<std::int64_t>(), field["max"].get<std::int64_t>());
  }
  if (field.contains("scale")) {
    text += fmt::format(", scale {}, offset {}", field["scale"].dump(), field["offset"].dump());
  }
  fmt::print("  {:<14} {}\n", "  field", text);
}

}  // namespace

ordered_json e57_facts(const std::filesystem::path& path) {
  const io::InputFile file(path);
  const io::E57Document document = io::read_e57_document(io::E57Pages(file));
  ordered_json scans = ordered_json::array();
  for (const io::E57Scan& scan : document.scans) scans.push_back(describe(scan));
  return {{"coordinate_system", document.coordinate_system}, {"scans", scans}};
}

void print_e57_facts(const ordered_json& facts) {
  std::size_t index = 0;
  for (const ordered_json& scan : facts["scans"]) {
    const auto sensor = scan["sensor"].get<std::string>();
    fmt::print("  {:<14} {}{}, {} points\n", fmt::format("scan {}", index++),
               scan["name"].get<std::string>(), sensor.empty() ? "" : ", " + sensor,
               scan["points"].get<std::size_t>());
    if (scan.contains("pose")) {
      fmt::print("  {:<14} moved by {}, turned by {} (w x y z)\n", "  pose",
                 scan["pose"]["translation"].dump(), scan["pose"]["rotation_wxyz"].dump());
    }
    fmt::print("  {:<14} {}\n", "  scanner",
               scan["scanner_known"].get<bool>() ? "known" : "unknown");
    for (const ordered_json& field : scan["fields"]) print_field(field);
  }
}

}  // namespace pcednet::app
