#include "pcednet/io/cloud_builder.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <array>
#include <cstring>
#include <utility>

#include "pcednet/core/error.h"
#include "pcednet/io/column_names.h"
#include "pcednet/io/promote.h"
#include "pcednet/io/strided.h"
#include "pcednet/io/text_scan.h"

namespace pcednet::io {
namespace {

using Names = std::vector<std::string>;

const std::array<Names, 3> kNormalNames = {
    {{"nx", "ny", "nz"}, {"normal_x", "normal_y", "normal_z"}, {"normalx", "normaly", "normalz"}}};

std::string list_names(const std::vector<Column>& columns) {
  Names names;
  for (const Column& column : columns) names.push_back(column.name);
  return names.empty() ? "nothing" : fmt::format("{}", fmt::join(names, " "));
}

/// Takes the numbers of the points [begin, end).
void copy_to(Attribute& attribute, const std::byte* from, std::size_t stride, std::size_t begin,
             std::size_t end) {
  const std::size_t bytes = attribute.stride();
  copy_numbers(from, stride, attribute.bytes.data() + begin * bytes, bytes, bytes, end - begin);
}

void decode_axis(std::vector<Vec3>& vectors, std::size_t axis, ScalarType type,
                 const std::byte* first, std::size_t stride, std::size_t begin, std::size_t end) {
  visit_scalar(type, [&](auto number) {
    for (std::size_t i = begin; i < end; ++i, first += stride) {
      std::memcpy(&number, first, sizeof number);
      vectors[i].data()[axis] = static_cast<double>(number);
    }
  });
}

}  // namespace

CloudBuilder::CloudBuilder(const std::filesystem::path& path, std::vector<Column> columns,
                           std::size_t points)
    : columns_(std::move(columns)), targets_(columns_.size()) {
  for (const Column& column : columns_) row_bytes_ += column.count * size_of(column.type);
  if (!take({"x", "y", "z"}, Role::kPosition, false)) {
    throw Error(ErrorKind::kInsufficient, fmt::format("{}: points need x, y and z; there is {}",
                                                      path.string(), list_names(columns_)));
  }
  cloud_.position_type = common_position_type();
  cloud_.positions.resize(points);
  for (const Names& names : kNormalNames) {
    if (!take(names, Role::kNormal, false)) continue;
    cloud_.normals.resize(points);
    store_normals();
    break;
  }
  for (const Names& names : colour_names()) {
    if (!take(names, Role::kColour, true)) continue;
    cloud_.colours.resize(points);
    break;
  }
  for (const std::string& name : label_names()) {
    if (!take({name}, Role::kLabel, true)) continue;
    cloud_.labels.resize(points);
    break;
  }
  for (std::size_t c = 0; c < columns_.size(); ++c) {
    const Column& column = columns_[c];
    if (targets_[c].role != Role::kAttribute) continue;
    if (column.skip) {
      targets_[c].role = Role::kSkip;
      continue;
    }
    targets_[c].index = cloud_.attributes.size();
    cloud_.attributes.push_back(new_attribute(column));
  }
}

Attribute CloudBuilder::new_attribute(const Column& column) const {
  Attribute attribute{column.name, column.type, column.count, {}};
  attribute.bytes.resize(size() * attribute.stride());
  return attribute;
}

void CloudBuilder::store_normals() {
  cloud_.stored_normals.resize(3);
  for (std::size_t c = 0; c < columns_.size(); ++c) {
    if (targets_[c].role != Role::kNormal) continue;
    cloud_.stored_normals[targets_[c].index] = new_attribute(columns_[c]);
  }
}

/// Gives the columns of these names (all or none of them) their role; with `bytes_only` only
/// columns of type uint8 qualify.
bool CloudBuilder::take(const Names& names, Role role, bool bytes_only) {
  std::vector<std::size_t> found;
  for (const std::string& name : names) {
    for (std::size_t c = 0; c < columns_.size(); ++c) {
      const Column& column = columns_[c];
      if (lower_case(column.name) != name) continue;
      const bool will_do = targets_[c].role == Role::kAttribute && column.count == 1 &&
                           !column.skip && (!bytes_only || column.type == ScalarType::kUint8);
      if (!will_do) continue;
      found.push_back(c);
      break;
    }
  }
  if (found.size() != names.size()) return false;
  for (std::size_t i = 0; i < found.size(); ++i) targets_[found[i]] = {role, i};
  return true;
}

ScalarType CloudBuilder::common_position_type() const {
  std::array<ScalarType, 3> types = {};
  for (std::size_t c = 0; c < columns_.size(); ++c) {
    if (targets_[c].role == Role::kPosition) types[targets_[c].index] = columns_[c].type;
  }
  return types[0] == types[1] && types[1] == types[2] ? types[0] : ScalarType::kFloat64;
}

void CloudBuilder::fill(std::size_t column, const std::byte* first, std::size_t stride,
                        std::size_t begin, std::size_t end) {
  if (begin >= end) return;
  const Target target = targets_[column];
  const ScalarType type = columns_[column].type;
  switch (target.role) {
    case Role::kSkip:
      return;
    case Role::kPosition:
      return decode_axis(cloud_.positions, target.index, type, first, stride, begin, end);
    case Role::kNormal:
      copy_to(cloud_.stored_normals[target.index], first, stride, begin, end);
      return decode_axis(cloud_.normals, target.index, type, first, stride, begin, end);
    case Role::kColour:
      for (std::size_t i = begin; i < end; ++i, first += stride) {
        cloud_.colours[i][target.index] = static_cast<std::uint8_t>(*first);
      }
      return;
    case Role::kLabel:
      for (std::size_t i = begin; i < end; ++i, first += stride) {
        cloud_.labels[i] = static_cast<std::uint8_t>(*first);
      }
      return;
    case Role::kAttribute:
      return copy_to(cloud_.attributes[target.index], first, stride, begin, end);
  }
}

void CloudBuilder::fill_rows(const std::byte* rows, std::size_t begin, std::size_t end) {
  if (begin >= end) return;  // `rows` may be null then
  std::size_t offset = 0;
  for (std::size_t c = 0; c < columns_.size(); ++c) {
    fill(c, rows + offset, row_bytes_, begin, end);
    offset += columns_[c].count * size_of(columns_[c].type);
  }
}

LoadedCloud CloudBuilder::finish() {
  LoadedCloud loaded;
  loaded.cloud = std::move(cloud_);
  if (loaded.cloud.labels.empty()) promote_labels(loaded.cloud);
  if (loaded.cloud.colours.empty()) promote_colours(loaded.cloud, loaded.warnings);
  restore_attributes(loaded.cloud);
  return loaded;
}

void widen_positions(std::vector<Column>& columns) {
  for (Column& column : columns) {
    const std::string name = lower_case(column.name);
    const bool is_axis = name == "x" || name == "y" || name == "z";
    if (is_axis && column.type == ScalarType::kFloat32) column.type = ScalarType::kFloat64;
  }
}

}  // namespace pcednet::io
