#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <cstring>
#include <optional>

#include "pcednet/core/error.h"
#include "pcednet/core/output_file.h"
#include "pcednet/io/las.h"
#include "pcednet/io/las_layout.h"
#include "pcednet/io/laz.h"
#include "pcednet/io/text_scan.h"
#include "pcednet/io/write_blocks.h"

namespace pcednet::io {
namespace {

constexpr std::size_t kHeader14 = 375;

[[noreturn]] void refuse(const std::filesystem::path& path, ErrorKind kind, std::size_t point,
                         const std::string& what) {
  throw Error(kind, fmt::format("{}: point {}: {}", path.string(), point, what));
}

/// Puts the points [begin, end) behind `out` as records.
void encode(const std::filesystem::path& path, const PointCloud& cloud, const LasLayout& layout,
            std::size_t begin, std::size_t end, std::string& out) {
  const std::size_t stride = layout.file.record_length(), start = out.size();
  out.resize(start + (end - begin) * stride);
  for (std::size_t i = begin; i < end; ++i) {
    for (std::size_t axis = 0; axis < 3; ++axis) {
      const double step = las_step(layout.file, axis, cloud.positions[i][static_cast<int>(axis)]);
      if (!std::isfinite(step)) {
        refuse(path, ErrorKind::kInsufficient, i, "LAS has no positions that are not finite");
      }
      const auto whole = static_cast<std::int32_t>(step);
      std::memcpy(&out[start + (i - begin) * stride + 4 * axis], &whole, 4);
    }
  }
  for (const LasColumn& column : layout.columns) {
    const LasField& field = column.field;
    char* to = &out[start] + field.offset;
    const std::byte* from = column.first + begin * column.stride;
    const std::size_t bytes = field.components * size_of(field.type);
    for (std::size_t i = begin; i < end; ++i, to += stride, from += column.stride) {
      if (field.bits > 0) {
        const auto value = std::to_integer<unsigned>(*from);
        if (value >> field.bits != 0) {
          refuse(path, ErrorKind::kFailure, i,
                 fmt::format("{} {} does not fit point format {}, which has {} bits for it",
                             field.name, value, layout.file.point_format(), field.bits));
        }
        *to = static_cast<char>(static_cast<unsigned char>(*to) | (value << field.shift));
      } else if (column.scale == LasColumn::Scale::kNone) {
        std::memcpy(to, from, bytes);
      } else {
        write_scaled(column, from, to);
      }
    }
  }
}

/// Counts by return number (index 0 for return 1), and the bounds.
struct Summary {
  std::array<std::uint64_t, 15> by_return = {};
  std::array<double, 3> least = {}, largest = {};
};

Summary summarise(const PointCloud& cloud, const LasFile& file) {
  Summary summary;
  const Attribute* returns = find_attribute(cloud, "ReturnNumber");
  for (std::size_t i = 0; i < cloud.size(); ++i) {
    const auto number = returns ? static_cast<std::size_t>(returns->value(i)) : 1;
    if (number >= 1 && number <= 15) ++summary.by_return[number - 1];
    for (std::size_t axis = 0; axis < 3; ++axis) {
      const double step = las_step(file, axis, cloud.positions[i][static_cast<int>(axis)]);
      const double value = step * file.scale(axis) + file.offset(axis);
      summary.least[axis] = i == 0 ? value : std::min(summary.least[axis], value);
      summary.largest[axis] = i == 0 ? value : std::max(summary.largest[axis], value);
    }
  }
  return summary;
}

/// Makes the header say what is written. `extended_offset`: where the extended records begin.
void update_header(LasFile& file, const PointCloud& cloud, std::uint64_t points_offset) {
  std::string& header = file.header;
  const Summary summary = summarise(cloud, file);
  const std::uint64_t count = cloud.size();
  const bool narrow = file.point_format() < 6 && count <= UINT32_MAX;
  put_number(header, 94, static_cast<std::uint16_t>(header.size()));
  put_number(header, 96, static_cast<std::uint32_t>(points_offset));
  put_number(header, 100, static_cast<std::uint32_t>(file.records.size()));
  put_number(header, 107, static_cast<std::uint32_t>(narrow ? count : 0));
  for (std::size_t r = 0; r < 5; ++r) {
    put_number(header, 111 + 4 * r, static_cast<std::uint32_t>(narrow ? summary.by_return[r] : 0));
  }
  for (std::size_t axis = 0; axis < 3; ++axis) {
    put_number(header, 179 + 16 * axis, summary.largest[axis]);
    put_number(header, 187 + 16 * axis, summary.least[axis]);
  }
  if (file.minor_version() < 4 || header.size() < kHeader14) return;
  put_number(header, 247, count);
  for (std::size_t r = 0; r < 15; ++r) put_number(header, 255 + 8 * r, summary.by_return[r]);
}

}  // namespace

void write_las(const std::filesystem::path& path, const PointCloud& cloud,
               const WriteOptions& options) {
  check_consistent(cloud);
  LasLayout layout = las_layout(cloud, options);
  LasFile& file = layout.file;
  const bool compress = lower_case(path.extension().string()) == ".laz";
  if (compress) add_laz_record(file);
  const std::string records = las_record_bytes(file.records, false);
  const std::uint64_t points_offset = file.header.size() + records.size();
  update_header(file, cloud, points_offset);
  OutputFile out(path, options.overwrite);
  std::string header = file.header;
  if (compress) put_number(header, 104, static_cast<std::uint8_t>(file.point_format() | 0x80U));
  out.write(header + records);
  const auto encode_points = [&](std::size_t begin, std::size_t end, std::string& bytes) {
    encode(path, cloud, layout, begin, end, bytes);
  };
  std::uint64_t end = points_offset + cloud.size() * file.record_length();
  if (compress) {
    end = points_offset + write_laz_points(out, file, cloud.size(), points_offset, encode_points);
  } else {
    write_blocks(out, cloud.size(), encode_points);
  }
  if (header.size() >= kHeader14 && file.minor_version() >= 4) {
    const bool any = !file.extended_records.empty();
    put_number<std::uint64_t>(header, 235, any ? end : 0);
    put_number(header, 243, static_cast<std::uint32_t>(file.extended_records.size()));
    out.write_at(0, std::as_bytes(std::span(header)));
    out.write(las_record_bytes(file.extended_records, true));
  }
  out.commit();
}

}  // namespace pcednet::io
