#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <cstring>

#include "pcednet/core/parallel.h"
#include "pcednet/io/las.h"
#include "pcednet/io/las_file.h"
#include "pcednet/io/laz.h"

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

/// Fills a cloud from point records.
class RecordSink {
 public:
  RecordSink(const LasFile& file, std::vector<std::string>& warnings)
      : stride_(file.record_length()), points_(file.point_count()) {
    for (std::size_t axis = 0; axis < 3; ++axis) {
      scale_[axis] = file.scale(axis);
      offset_[axis] = file.offset(axis);
    }
    const auto standard = las_standard_fields(file.point_format());
    fields_.assign(standard.begin() + 3, standard.end());
    const auto extra = las_extra_fields(file, warnings);
    fields_.insert(fields_.end(), extra.begin(), extra.end());
    cloud_.positions.resize(points_);
    for (const LasField& field : fields_) {
      Attribute attribute{field.name, field.type, field.components, {}};
      attribute.bytes.resize(points_ * attribute.stride());
      cloud_.attributes.push_back(std::move(attribute));
    }
  }

  void take(const std::byte* rows, std::size_t begin, std::size_t end) {
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

  PointCloud finish() { return std::move(cloud_); }

 private:
  std::size_t stride_, points_;
  std::array<double, 3> scale_ = {}, offset_ = {};
  std::vector<LasField> fields_;
  PointCloud cloud_;
};

void read_plain(const InputFile& file, const LasFile& las, std::vector<std::string>& warnings,
                PointCloud& cloud) {
  const std::uint64_t count = las.point_count(), stride = las.record_length();
  const std::uint64_t room = (file.size() - las.points_offset()) / stride;
  if (count > room) {
    throw unreadable(file.path(),
                     fmt::format("byte {}: ends after point {} of {}", file.size(), room, count));
  }
  RecordSink sink(las, warnings);
  parallel_blocks(count, 16384, [&](std::size_t begin, std::size_t end) {
    std::vector<std::byte> rows((end - begin) * stride);
    file.read(las.points_offset() + begin * stride, rows);
    sink.take(rows.data(), begin, end);
  });
  cloud = sink.finish();
}

void read_compressed(const InputFile& file, LasFile& las, std::vector<std::string>& warnings,
                     PointCloud& cloud) {
  const LazReader reader(file, las);
  RecordSink sink(las, warnings);
  parallel_blocks(reader.chunk_count(), 1, [&](std::size_t chunk, std::size_t) {
    const std::vector<std::byte> rows = reader.decode(chunk);
    const std::size_t begin = reader.chunk_begin(chunk);
    sink.take(rows.data(), begin, begin + rows.size() / las.record_length());
  });
  cloud = sink.finish();
  std::erase_if(las.records, [](const LasRecord& r) { return r.is("laszip encoded", 22204); });
  auto format = static_cast<std::uint8_t>(las.point_format());
  put_number(las.header, 104, format);
}

/// Moves NormalX, NormalY and NormalZ to the normals.
void promote_normals(PointCloud& cloud) {
  std::array<const Attribute*, 3> axes = {find_attribute(cloud, "NormalX"),
                                          find_attribute(cloud, "NormalY"),
                                          find_attribute(cloud, "NormalZ")};
  for (const Attribute* axis : axes) {
    if (axis == nullptr || axis->components != 1) return;
    if (axis->type != ScalarType::kFloat32 && axis->type != ScalarType::kFloat64) return;
  }
  cloud.normals.resize(cloud.size());
  for (std::size_t i = 0; i < cloud.size(); ++i) {
    cloud.normals[i] = Vec3(axes[0]->value(i), axes[1]->value(i), axes[2]->value(i));
  }
  std::erase_if(cloud.attributes, [](const Attribute& a) {
    return a.name == "NormalX" || a.name == "NormalY" || a.name == "NormalZ";
  });
}

void promote_label(PointCloud& cloud) {
  const Attribute* label = find_attribute(cloud, "label");
  if (!label || label->type != ScalarType::kUint8 || label->components != 1) return;
  cloud.labels.resize(cloud.size());
  for (std::size_t i = 0; i < cloud.size(); ++i) {
    cloud.labels[i] = static_cast<std::uint8_t>(label->bytes[i]);
  }
  std::erase_if(cloud.attributes, [](const Attribute& a) { return a.name == "label"; });
}

}  // namespace

std::vector<Rgb> las_colours(const PointCloud& cloud) {
  const std::array<const Attribute*, 3> channels = {
      find_attribute(cloud, "Red"), find_attribute(cloud, "Green"), find_attribute(cloud, "Blue")};
  std::array<const std::byte*, 3> first = {};
  for (std::size_t c = 0; c < 3; ++c) {
    const bool fits = channels[c] != nullptr && channels[c]->components == 1 &&
                      channels[c]->type == ScalarType::kUint16;
    if (!fits) return {};
    first[c] = channels[c]->bytes.data();
  }
  const auto value = [&](std::size_t point, std::size_t c) {
    std::uint16_t number = 0;
    std::memcpy(&number, first[c] + 2 * point, 2);
    return number;
  };
  unsigned largest = 0;
  for (std::size_t i = 0; i < cloud.size(); ++i) {
    for (std::size_t c = 0; c < 3; ++c) largest = std::max<unsigned>(largest, value(i, c));
  }
  std::vector<Rgb> colours(cloud.size());
  for (std::size_t i = 0; i < cloud.size(); ++i) {
    for (std::size_t c = 0; c < 3; ++c) {
      const unsigned number = value(i, c);
      colours[i][c] = static_cast<std::uint8_t>(largest < 256 ? number : (number + 128) / 257);
    }
  }
  return colours;
}

LoadedCloud read_las(const InputFile& file) {
  LoadedCloud loaded;
  LasFile las = read_las_file(file, loaded.warnings);
  if (las.compressed()) {
    read_compressed(file, las, loaded.warnings, loaded.cloud);
  } else {
    read_plain(file, las, loaded.warnings, loaded.cloud);
  }
  loaded.cloud.colours = las_colours(loaded.cloud);
  promote_normals(loaded.cloud);
  promote_label(loaded.cloud);
  attach_las_file(loaded.cloud, las);
  return loaded;
}

}  // namespace pcednet::io
