#include <fmt/format.h>

#include <array>

#include "decimal_bounds.h"
#include "facts.h"

namespace pcednet::app {
namespace {

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
          {"coordinate_system", las.coordinate_system},
          {"records", records},
          {"extra_bytes", las.extra_bytes},
          {"points_by_return", json_of(las.points_by_return)},
          {"points_by_class", json_of(las.points_by_class)}};
}

}  // namespace

const char* name_of(ScalarType type) {
  static constexpr std::array kNames = {"int8",   "uint8", "int16",  "uint16",  "int32",
                                        "uint32", "int64", "uint64", "float32", "float64"};
  return kNames[static_cast<std::size_t>(type)];
}

const char* name_of(io::E57Field::Kind kind) {
  static constexpr std::array kNames = {"integer", "scaled integer", "single", "double", "string"};
  return kNames[static_cast<std::size_t>(kind)];
}

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

}  // namespace pcednet::app
