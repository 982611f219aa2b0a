#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <cstring>
#include <optional>

#include "pcednet/cloud/bounding_box.h"
#include "pcednet/core/error.h"
#include "pcednet/core/output_file.h"
#include "pcednet/io/las/copc.h"
#include "pcednet/io/las/las.h"
#include "pcednet/io/las/layout.h"
#include "pcednet/io/las/laz.h"
#include "pcednet/io/text_scan.h"
#include "pcednet/io/write_blocks.h"

namespace pcednet::io {
namespace {

[[noreturn]] void refuse(const std::filesystem::path& path, ErrorKind kind, std::size_t point,
                         const std::string& what) {
  throw Error(kind, fmt::format("{}: point {}: {}", path.string(), point, what));
}

/// The integer of a coordinate. Throws if LAS has none for it.
double checked_step(const std::filesystem::path& path, const LasFile& file, std::size_t axis,
                    double coordinate, std::size_t point) {
  const double step = las_step(file, axis, coordinate);
  if (std::isfinite(step)) return step;
  refuse(
      path, ErrorKind::kInsufficient, point,
      std::isfinite(coordinate)
          ? fmt::format("{} does not fit into 32 bits in steps of {}", coordinate, file.scale(axis))
          : "LAS cannot hold positions that are not finite; PLY, PCD and text can");
}

/// Puts the points [begin, end) of a part behind `out` as records. `before`: points of earlier
/// parts.
void encode(const std::filesystem::path& path, const PointCloud& cloud, const LasLayout& layout,
            std::size_t before, std::size_t begin, std::size_t end, std::string& out) {
  const std::size_t stride = layout.file.record_length(), start = out.size();
  out.resize(start + (end - begin) * stride);
  for (std::size_t i = begin; i < end; ++i) {
    for (std::size_t axis = 0; axis < 3; ++axis) {
      const double coordinate = cloud.positions[i][static_cast<int>(axis)];
      const double step = checked_step(path, layout.file, axis, coordinate, before + i);
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
      char number[8];
      const bool is_scaled = column.scale != LasColumn::Scale::kNone;
      if (is_scaled) write_scaled(column, from, number);
      const void* value_bytes = is_scaled ? static_cast<const void*>(number) : from;
      if (field.bits > 0) {
        const unsigned value = *static_cast<const unsigned char*>(value_bytes);
        if (value >> field.bits != 0) {
          refuse(path, ErrorKind::kFailure, before + i,
                 fmt::format("{} {} does not fit point format {}, which has {} bits for it",
                             field.name, value, layout.file.point_format(), field.bits));
        }
        *to = static_cast<char>(static_cast<unsigned char>(*to) | (value << field.shift));
      } else {
        std::memcpy(to, value_bytes, bytes);
      }
    }
  }
}

/// Counts by return number (index 0 for return 1), the bounds, and those of the times.
struct Summary {
  std::array<std::uint64_t, las_header::kReturns64> by_return = {};
  BoundingBox bounds = {};
  double least_time = INFINITY, most_time = -INFINITY;

  bool timed() const { return least_time <= most_time; }
  double first() const { return timed() ? least_time : 0.0; }
  double last() const { return timed() ? most_time : 0.0; }

  void add(const PointCloud& part, const LasFile& file, const LasSources& sources) {
    const Attribute* times = las_source(part, sources, "GpsTime", ScalarType::kFloat64);
    for (std::size_t i = 0; times && i < part.size(); ++i) {
      least_time = std::min(least_time, times->value(i));
      most_time = std::max(most_time, times->value(i));
    }
    const Attribute* returns = las_source(part, sources, "ReturnNumber", ScalarType::kUint8);
    for (std::size_t i = 0; i < part.size(); ++i) {
      const auto number = returns ? static_cast<std::size_t>(returns->value(i)) : 1;
      if (number >= 1 && number <= by_return.size()) ++by_return[number - 1];
      for (std::size_t axis = 0; axis < 3; ++axis) {
        const int a = static_cast<int>(axis);
        const double step = las_step(file, axis, part.positions[i][a]);
        const double value = step * file.scale(axis) + file.offset(axis);
        bounds.min[a] = std::min(bounds.min[a], value);
        bounds.max[a] = std::max(bounds.max[a], value);
      }
    }
  }
};

/// Updates the header to the written points.
void update_header(LasFile& file, const Summary& summary, std::uint64_t count,
                   std::uint64_t points_offset) {
  std::string& header = file.header;
  const bool wide = file.counts_wide();
  file.set_point_count(count);
  if (file.point_count() != count) {
    throw Error(ErrorKind::kFailure,
                fmt::format("LAS 1.{} cannot count {} points", file.minor_version(), count));
  }
  put_number(header, las_header::kHeaderBytes, static_cast<std::uint16_t>(header.size()));
  put_number(header, las_header::kPointsOffset, static_cast<std::uint32_t>(points_offset));
  put_number(header, las_header::kRecordCount, static_cast<std::uint32_t>(file.records.size()));
  const bool narrow = number_at<std::uint32_t>(header, las_header::kPointCount32) == count;
  for (std::size_t r = 0; r < las_header::kReturns32; ++r) {
    put_number(header, las_header::kByReturn32 + 4 * r,
               static_cast<std::uint32_t>(narrow ? summary.by_return[r] : 0));
  }
  for (std::size_t axis = 0; axis < 3; ++axis) {
    const int a = static_cast<int>(axis);
    put_number(header, las_header::kBounds + 16 * axis, count == 0 ? 0.0 : summary.bounds.max[a]);
    put_number(header, las_header::kBounds + 8 + 16 * axis,
               count == 0 ? 0.0 : summary.bounds.min[a]);
  }
  if (!wide) return;
  for (std::size_t r = 0; r < las_header::kReturns64; ++r) {
    put_number(header, las_header::kByReturn64 + 8 * r, summary.by_return[r]);
  }
  if (!file.has_time_range()) return;
  put_number(header, las_header::kLastTime, summary.last());
  put_number(header, las_header::kFirstTime, summary.first());
}

class LasPartWriter : public PartWriter {
 public:
  LasPartWriter(const std::filesystem::path& path, const PartOutline& outline,
                const WriteOptions& options)
      : path_(path), options_(options), choices_(las_choices(path, outline)) {
    losses = las_losses(*outline.first, choices_);
    LasLayout layout = las_layout(*outline.first, options, choices_);
    file_ = std::move(layout.file);
    losses.insert(losses.end(), layout.losses.begin(), layout.losses.end());
    const bool is_copc = is_copc_name(path);
    const bool compress = extension_of(path) == ".laz";
    if (compress) add_laz_record(file_, is_copc ? LazChunks::kVariable : LazChunks::kEqual);
    const std::string records = las_record_bytes(file_.records, false) + file_.before_points;
    points_offset_ = file_.header.size() + records.size();
    if (points_offset_ > UINT32_MAX) {
      throw Error(ErrorKind::kFailure,
                  path.string() + ": more than 4 GiB before the points, which LAS cannot hold");
    }
    out_.emplace(path, options.overwrite);
    out_->write(file_.header + records);  // the header is written again at the end
    if (is_copc) {
      copc_.emplace(*out_, path, file_, points_offset_);
    } else if (compress) {
      compressed_.emplace(*out_, file_, points_offset_);
    }
    // The layout of the parts needs no other records.
    std::erase_if(choices_.file.records, [](const auto& r) { return !r.is(kExtraBytesRecord); });
    choices_.file.extended_records.clear();
    choices_.file.before_points.clear();
  }

  void append(const PointCloud& part) override {
    check_consistent(part);
    const LasLayout layout = las_layout(part, options_, choices_);
    if (layout.file.record_length() != file_.record_length()) {
      throw Error(ErrorKind::kFailure,
                  path_.string() + ": the parts to write have different attributes");
    }
    const auto encode_points = [&](std::size_t begin, std::size_t end, std::string& bytes) {
      encode(path_, part, layout, count_, begin, end, bytes);
    };
    if (copc_) {
      copc_->append(part.size(), encode_points);
    } else if (compressed_) {
      compressed_->append(part.size(), encode_points);
    } else {
      write_blocks(*out_, part.size(), encode_points);
    }
    summary_.add(part, file_, choices_.sources);
    count_ += part.size();
  }

  void commit() override {
    std::uint64_t end = points_offset_ + count_ * file_.record_length();
    if (copc_) {
      end = finish_copc();
    } else if (compressed_) {
      end = points_offset_ + compressed_->finish();
    }
    update_header(file_, summary_, count_, points_offset_);
    std::string& header = file_.header;
    if (copc_ || compressed_) {
      put_number(header, las_header::kPointFormat,
                 static_cast<std::uint8_t>(file_.point_format() | las_header::kCompressedBit));
    }
    if (place_extended_records(file_, end)) {
      out_->write(las_record_bytes(file_.extended_records, true));
    }
    out_->write_at(0, std::as_bytes(std::span(header)));
    out_->commit();
  }

 private:
  /// Writes the points and the record about them, and returns where they end.
  std::uint64_t finish_copc() {
    const std::uint64_t end = points_offset_ + copc_->finish(summary_.bounds, options_.progress);
    auto& extended = file_.extended_records;
    extended.insert(extended.begin(),
                    new_record(kCopcHierarchyRecord, "COPC hierarchy", copc_->hierarchy()));
    const std::string info =
        copc_->info(end + las_record::kExtendedHeadBytes, summary_.first(), summary_.last());
    out_->write_at(las_header::kBytes14 + las_record::kHeadBytes, std::as_bytes(std::span(info)));
    return end;
  }

  std::filesystem::path path_;
  WriteOptions options_;
  LasChoices choices_;
  LasFile file_ = {};
  std::uint64_t points_offset_ = 0, count_ = 0;
  Summary summary_ = {};
  std::optional<OutputFile> out_ = {};
  std::optional<LazPointWriter> compressed_ = {};
  std::optional<CopcPointWriter> copc_ = {};
};

}  // namespace

void check_las_positions(const std::filesystem::path& path, const PointCloud& cloud) {
  const LasFile file = las_choices(path, outline_of(cloud)).file;
  for (std::size_t i = 0; i < cloud.size(); ++i) {
    for (std::size_t axis = 0; axis < 3; ++axis) {
      checked_step(path, file, axis, cloud.positions[i][static_cast<int>(axis)], i);
    }
  }
}

std::unique_ptr<PartWriter> create_las_parts(const std::filesystem::path& path,
                                             const PartOutline& outline,
                                             const WriteOptions& options) {
  check_consistent(*outline.first);
  return std::make_unique<LasPartWriter>(path, outline, options);
}

}  // namespace pcednet::io
