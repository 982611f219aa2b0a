#include "pcednet/io/las/facts.h"

#include <fmt/format.h>

#include <algorithm>
#include <utility>

#include "pcednet/io/promote.h"

namespace pcednet::io {
namespace {

std::string text_at(std::string_view header, std::size_t offset) {
  return until_zero(header.substr(offset, las_header::kTextBytes));
}

/// The citations share one text, separated by bars.
std::string coordinate_system(const LasFile& file) {
  std::string citations;
  for (const LasRecord* record : all_records(file)) {
    std::string text = until_zero(record->data);
    if (record->is(kWktRecord)) return text;
    if (record->is(kGeoTextRecord)) citations = text;
  }
  std::replace(citations.begin(), citations.end(), '|', ' ');
  return citations;
}

/// Counts the points with each value of a field.
void count_values(const PointCloud& points, const char* name, std::map<int, std::size_t>& counts) {
  const Attribute* field = find_attribute(points, name);
  if (!field) return;
  for (std::size_t i = 0; i < points.size(); ++i) ++counts[static_cast<int>(field->value(i))];
}

/// Whether the record that COPC requires comes first, which read_las_file leaves out.
bool begins_with_copc_record(const InputFile& file) {
  const std::string user_id =
      file.text(las_header::kBytes14 + las_record::kUserId, las_record::kUserIdBytes);
  return until_zero(user_id) == kCopcInfoRecord.user_id;
}

constexpr std::array<std::string_view, kLasClasses> kClassNames = {
    "never classified",
    "unassigned",
    "ground",
    "low vegetation",
    "medium vegetation",
    "high vegetation",
    "building",
    "low noise",
    "model key point",
    "water",
    "rail",
    "road surface",
    "overlap",
    "guard wire",
    "conductor wire",
    "transmission tower",
    "wire connector",
    "bridge deck",
    "high noise",
    "overhead structure",
    "ignored ground",
    "snow",
    "temporal exclusion",
};

}  // namespace

std::string_view las_class_name(unsigned code) {
  return code < kClassNames.size() ? kClassNames[code] : std::string_view();
}

std::string_view las_class_name(unsigned code, unsigned point_format) {
  constexpr unsigned kModelKeyPoint = 8, kWater = 9, kOverlap = 12, kHighNoise = 18;
  const bool is_of_old = code <= kWater || code == kOverlap || code == kHighNoise;
  const bool is_of_new = code != kModelKeyPoint && code != kOverlap;
  return (point_format < 6 ? is_of_old : is_of_new) ? las_class_name(code) : std::string_view();
}

LasOutline las_outline(const InputFile& file) {
  std::vector<std::string> warnings;
  const LasFile las = read_las_file(file, warnings);
  LasOutline outline{
      .points = las.point_count(),
      .compressed = las.compressed(),
      .copc = las.compressed() && begins_with_copc_record(file),
      .created_day = number_at<std::uint16_t>(las.header, las_header::kCreationDay),
      .created_year = number_at<std::uint16_t>(las.header, las_header::kCreationYear),
      .coordinate_system = coordinate_system_of(las),
      .fields = las_standard_fields(las.point_format())};
  for (std::size_t axis = 0; axis < 3; ++axis) {
    const std::size_t at = las_header::kBounds + 16 * axis;
    outline.bounds.max[static_cast<int>(axis)] = number_at<double>(las.header, at);
    outline.bounds.min[static_cast<int>(axis)] = number_at<double>(las.header, at + 8);
  }
  const BoundingBox& bounds = outline.bounds;
  const bool are_bounds = (bounds.min.array() <= bounds.max.array()).all() &&
                          bounds.min.allFinite() && bounds.max.allFinite();
  if (!are_bounds) outline.bounds = {};
  for (LasField& field : las_extra_fields(las, warnings)) {
    outline.fields.push_back(std::move(field));
  }
  return outline;
}

LasFacts las_facts(const InputFile& file) {
  std::vector<std::string> warnings;  // read_las() reports them
  const LasFile las = read_las_file(file, warnings);
  LasFacts facts{.minor_version = las.minor_version(),
                 .point_format = las.point_format(),
                 .compressed = las.compressed(),
                 .copc = las.compressed() && begins_with_copc_record(file),
                 .system = text_at(las.header, las_header::kSystem),
                 .software = text_at(las.header, las_header::kSoftware),
                 .created_day = number_at<std::uint16_t>(las.header, las_header::kCreationDay),
                 .created_year = number_at<std::uint16_t>(las.header, las_header::kCreationYear),
                 .scale = {las.scale(0), las.scale(1), las.scale(2)},
                 .offset = {las.offset(0), las.offset(1), las.offset(2)},
                 .code = code_text(coordinate_system_of(las)),
                 .coordinate_system = coordinate_system(las),
                 .records = {},
                 .extra_bytes = {},
                 .points_by_return = {},
                 .points_by_class = {}};
  for (const LasRecord* record : all_records(las)) {
    facts.records.push_back(
        {record->user_id, record->record_id, record->description, record->data.size()});
  }
  for (const LasField& field : las_extra_fields(las, warnings)) {
    facts.extra_bytes.push_back(field.name);
  }
  return facts;
}

void count_points(const PointCloud& points, LasFacts& facts) {
  count_values(points, "ReturnNumber", facts.points_by_return);
  count_values(points, "Classification", facts.points_by_class);
}

std::size_t count_withheld(const PointCloud& points) {
  const Attribute* field = find_called(points, "withheld");
  std::size_t withheld = 0;
  for (std::size_t i = 0; field && i < points.size(); ++i) withheld += field->value(i) != 0.0;
  return withheld;
}

std::string note_on_withheld(std::size_t withheld, std::size_t points) {
  if (withheld == 0) return {};
  return fmt::format(
      "{} of {} points are withheld (deleted): labelled like all others; convert --drop-flag "
      "withheld leaves them out",
      withheld, points);
}

}  // namespace pcednet::io
