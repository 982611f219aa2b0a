#include "pcednet/io/las/records.h"

#include <fmt/format.h>

#include <algorithm>
#include <cstring>

#include "pcednet/core/bytes.h"

namespace pcednet::io {
namespace {

/// Takes a column out of records of `stride` bytes.
template <typename T>
void copy_column(const LasField& field, const std::byte* rows, std::size_t stride, std::byte* to,
                 std::size_t count) {
  const std::size_t bytes = field.components * sizeof(T);
  for (std::size_t i = 0; i < count; ++i) {
    std::memcpy(to + i * bytes, rows + i * stride + field.offset, bytes);
  }
}

void take_column(const LasField& field, const std::byte* rows, std::size_t stride, std::byte* to,
                 std::size_t count) {
  if (field.bits == 0) {
    return visit_scalar(field.type, [&](auto zero) {
      copy_column<decltype(zero)>(field, rows, stride, to, count);
    });
  }
  const unsigned mask = (1U << field.bits) - 1;
  for (std::size_t i = 0; i < count; ++i) {
    to[i] = (rows[i * stride + field.offset] >> field.shift) & std::byte(mask);
  }
}

/// Moves NormalX, NormalY and NormalZ to the normals.
void promote_normals(PointCloud& cloud) {
  std::array<const Attribute*, 3> axes = {};
  for (std::size_t a = 0; a < axes.size(); ++a) {
    const Attribute* const axis = axes[a] = find_attribute(cloud, kLasNormals[a]);
    if (axis == nullptr || axis->components != 1) return;
    if (!is_floating(axis->type)) return;
  }
  cloud.normals.resize(cloud.size());
  for (std::size_t i = 0; i < cloud.size(); ++i) {
    cloud.normals[i] = Vec3(axes[0]->value(i), axes[1]->value(i), axes[2]->value(i));
  }
  cloud.stored_normals = {*axes[0], *axes[1], *axes[2]};
  for (const char* name : kLasNormals) erase_attribute(cloud, name);
}

void promote_label(PointCloud& cloud) {
  const Attribute* label = find_attribute(cloud, "label");
  if (!label || label->type != ScalarType::kUint8 || label->components != 1) return;
  cloud.labels.resize(cloud.size());
  for (std::size_t i = 0; i < cloud.size(); ++i) {
    cloud.labels[i] = static_cast<std::uint8_t>(label->bytes[i]);
  }
  erase_attribute(cloud, "label");
}

/// The first numbers of Red, Green and Blue; null if there are none.
std::array<const std::byte*, 3> colour_channels(const PointCloud& cloud) {
  std::array<const std::byte*, 3> first = {};
  for (std::size_t c = 0; c < 3; ++c) {
    const Attribute* channel = find_attribute(cloud, kLasChannels[c]);
    const bool fits =
        channel != nullptr && channel->components == 1 && channel->type == ScalarType::kUint16;
    if (!fits) return {};
    first[c] = channel->bytes.data();
  }
  return first;
}

unsigned number_of(const std::byte* first, std::size_t point) {
  return load<std::uint16_t>(first + 2 * point);
}

}  // namespace

LasRecordSink::LasRecordSink(const LasFile& file, std::size_t points,
                             std::vector<std::string>& warnings)
    : stride_(file.record_length()) {
  for (std::size_t axis = 0; axis < 3; ++axis) {
    scale_[axis] = file.scale(axis);
    offset_[axis] = file.offset(axis);
  }
  const auto standard = las_standard_fields(file.point_format());
  fields_.assign(standard.begin() + 3, standard.end());
  const auto extra = las_extra_fields(file, warnings);
  fields_.insert(fields_.end(), extra.begin(), extra.end());
  for (const LasField& field : fields_) {
    cloud_.attributes.push_back({field.name, field.type, field.components, {}});
  }
  grow(points);
}

void LasRecordSink::grow(std::size_t points) {
  cloud_.positions.resize(points);
  for (Attribute& attribute : cloud_.attributes) {
    attribute.bytes.resize(points * attribute.stride());
  }
}

void LasRecordSink::take(const std::byte* rows, std::size_t begin, std::size_t end) {
  for (std::size_t i = begin; i < end; ++i) {
    std::array<std::int32_t, 3> steps;
    std::memcpy(steps.data(), rows + (i - begin) * stride_, sizeof steps);
    for (std::size_t axis = 0; axis < 3; ++axis) {
      cloud_.positions[i].data()[axis] = steps[axis] * scale_[axis] + offset_[axis];
    }
  }
  for (std::size_t f = 0; f < fields_.size(); ++f) {
    Attribute& attribute = cloud_.attributes[f];
    take_column(fields_[f], rows, stride_, attribute.bytes.data() + begin * attribute.stride(),
                end - begin);
  }
}

PointCloud LasRecordSink::finish() {
  promote_normals(cloud_);
  promote_label(cloud_);
  return std::move(cloud_);
}

void check_las_points(const InputFile& file, LasFile& las, std::vector<std::string>& warnings) {
  const std::uint64_t count = las.point_count(), begin = las.points_offset();
  const std::uint64_t most = (file.size() - begin) / las.record_length();
  if (count > most) {
    throw unreadable(file.path(),
                     fmt::format("byte {}: ends after point {} of {}", file.size(), most, count));
  }
  std::uint64_t room = (las_points_limit(file, las) - begin) / las.record_length();
  if (!las.counts_wide()) room = std::min<std::uint64_t>(room, UINT32_MAX);
  // Extended records whose offset the header does not give may lie behind the points.
  const bool all_found =
      !las.counts_wide() || las.extended_records.size() ==
                                number_at<std::uint32_t>(las.header, las_header::kExtendedCount);
  if (room <= count || !all_found) return;
  if (count > 0) {
    warnings.push_back(
        fmt::format("the header counts {} points and the file has room for {} more behind them: "
                    "these are left out",
                    count, room - count));
    return;
  }
  las.set_point_count(room);
  warnings.push_back(fmt::format(
      "the header counts no points, as where writing was interrupted: the {} that are there are "
      "read",
      room));
}

void forget_compression(LasFile& las) {
  std::erase_if(las.records, [](const LasRecord& r) { return r.is(kLaszipRecord); });
  const auto format = static_cast<std::uint8_t>(las.point_format());
  put_number(las.header, las_header::kPointFormat, format);
}

bool has_narrow_colours(const PointCloud& cloud) {
  for (const std::byte* channel : colour_channels(cloud)) {
    for (std::size_t i = 0; channel && i < cloud.size(); ++i) {
      if (number_of(channel, i) > 255) return false;
    }
  }
  return true;
}

std::vector<Rgb> las_colours(const PointCloud& cloud, bool narrow) {
  const auto channels = colour_channels(cloud);
  if (!channels[0]) return {};
  std::vector<Rgb> colours(cloud.size());
  for (std::size_t i = 0; i < cloud.size(); ++i) {
    for (std::size_t c = 0; c < 3; ++c) {
      const unsigned number = number_of(channels[c], i);
      colours[i][c] = static_cast<std::uint8_t>(narrow ? number : (number + 128) / 257);
    }
  }
  return colours;
}

}  // namespace pcednet::io
