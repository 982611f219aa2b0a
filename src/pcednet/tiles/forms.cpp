#include "pcednet/tiles/forms.h"

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <string>
#include <utility>
#include <vector>

#include "pcednet/io/las/merge.h"
#include "pcednet/io/las/records.h"

namespace pcednet::tiles {
namespace {

constexpr const char* kRank = "ScanAngleRank";  ///< of point formats 0 to 5, in degrees
constexpr const char* kAngle = "ScanAngle";     ///< of 6 to 10

bool is_same_column(const Attribute& a, const Attribute& b) {
  return a.name == b.name && a.type == b.type && a.components == b.components;
}

bool has_columns_of(const PointCloud& outline, const PointCloud& part) {
  return std::ranges::equal(outline.attributes, part.attributes, is_same_column);
}

Attribute angles_from(const Attribute& ranks) {
  std::vector<std::int16_t> steps(ranks.bytes.size() / ranks.stride());
  for (std::size_t i = 0; i < steps.size(); ++i) {
    steps[i] = static_cast<std::int16_t>(std::lround(ranks.value(i) / io::kLasAngleStep));
  }
  return make_attribute(kAngle, steps);
}

/// The column of the part, or zeros.
Attribute column_of(const Attribute& wanted, PointCloud& part) {
  for (Attribute& own : part.attributes) {
    if (is_same_column(own, wanted)) return std::move(own);
  }
  const Attribute* ranks = find_attribute(part, kRank);
  if (wanted.name == kAngle && ranks) return angles_from(*ranks);
  Attribute zeros{wanted.name, wanted.type, wanted.components, {}};
  zeros.bytes.resize(part.size() * zeros.stride());
  return zeros;
}

}  // namespace

PointCloud merge_outlines(std::vector<PointCloud> outlines, std::size_t timed) {
  std::vector<io::LasFile> files;
  for (const PointCloud& outline : outlines) files.push_back(io::attached_las_file(outline));
  const io::LasFile merged = io::merge_las_files(files, timed);
  std::vector<std::string> known;
  PointCloud outline = std::move(outlines.front());
  const Attribute* scan = find_attribute(outline, "scan");  // of the plan, not of the file
  std::vector<Attribute> columns = io::LasRecordSink(merged, 0, known).finish().attributes;
  if (scan) {
    std::erase_if(columns, [](const Attribute& column) { return column.name == "scan"; });
    columns.push_back(*scan);
  }
  outline.attributes = std::move(columns);
  std::erase_if(outline.foreign_elements, io::is_las_element);
  io::attach_las_file(outline, merged);
  return outline;
}

void take_columns(const PointCloud& outline, PointCloud& part) {
  if (has_columns_of(outline, part)) return;
  std::vector<Attribute> columns;
  for (const Attribute& wanted : outline.attributes) columns.push_back(column_of(wanted, part));
  part.attributes = std::move(columns);
  if (part.colours.empty() && find_attribute(outline, "Red")) part.colours.resize(part.size());
}

}  // namespace pcednet::tiles
