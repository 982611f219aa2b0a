#pragma once

#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "pcednet/cloud/point_cloud.h"
#include "pcednet/core/bytes.h"
#include "pcednet/io/coordinate_system.h"
#include "pcednet/io/input_file.h"
#include "pcednet/io/las/offsets.h"

namespace pcednet::io {

/// One field of a point record: a whole number of bytes, or some bits of one byte.
struct LasField {
  std::string name;
  ScalarType type = ScalarType::kUint8;
  std::size_t offset = 0;      ///< bytes into the record
  std::size_t components = 1;  ///< numbers one after the other
  unsigned shift = 0;
  unsigned bits = 0;                           ///< 0: the whole number
  std::optional<std::size_t> descriptor = {};  ///< where the record LASF_Spec 4 describes it
};

/// A variable length record, or an extended one.
struct LasRecord {
  std::string user_id;
  std::uint16_t record_id = 0;
  std::string description;
  std::string data = {};
  std::string head = {};  ///< everything before the data, as in the file; empty: a new record

  bool is(const LasRecordKind& kind) const {
    return user_id == kind.user_id && record_id == kind.record_id;
  }
};

LasRecord new_record(const LasRecordKind& kind, std::string description, std::string data);

/// The first record of that kind; null if there is none.
const LasRecord* find_record(const std::vector<LasRecord>& records, const LasRecordKind& kind);
LasRecord* find_record(std::vector<LasRecord>& records, const LasRecordKind& kind);

/// The number of type T at `offset` of little-endian bytes (the only order LAS has).
template <typename T>
T number_at(std::string_view bytes, std::size_t offset) {
  return offset + sizeof(T) <= bytes.size() ? load<T>(bytes.data() + offset) : T{};
}

/// The text of a zero-padded field.
inline std::string until_zero(std::string_view text) {
  return std::string(text.substr(0, text.find('\0')));
}

template <typename T>
void put_number(std::string& bytes, std::size_t offset, T value) {
  if (offset + sizeof value <= bytes.size()) store(bytes.data() + offset, value);
}

/// The contents of a LAS file around its points. The public header block is kept verbatim; the
/// accessors read it.
struct LasFile {
  std::string header = {};
  std::vector<LasRecord> records = {}, extended_records = {};
  std::string before_points = {};  ///< bytes behind the records that belong to no record

  unsigned minor_version() const {
    return number_at<std::uint8_t>(header, las_header::kMinorVersion);
  }
  unsigned point_format() const {
    return number_at<std::uint8_t>(header, las_header::kPointFormat) & las_header::kFormatBits;
  }
  bool compressed() const {
    return (number_at<std::uint8_t>(header, las_header::kPointFormat) &
            las_header::kCompressedBits) != 0;
  }
  /// Never 0: the reader rejects such files.
  std::size_t record_length() const {
    return std::max<std::size_t>(number_at<std::uint16_t>(header, las_header::kRecordLength), 1);
  }
  std::uint64_t points_offset() const {
    return number_at<std::uint32_t>(header, las_header::kPointsOffset);
  }
  /// Whether the header has the 64-bit counts of LAS 1.4.
  bool counts_wide() const;
  /// Whether it has the range of the times (LAS 1.5).
  bool has_time_range() const;
  std::uint64_t point_count() const;
  void set_point_count(std::uint64_t count);
  double scale(std::size_t axis) const {
    return number_at<double>(header, las_header::kScales + 8 * axis);
  }
  double offset(std::size_t axis) const {
    return number_at<double>(header, las_header::kOffsets + 8 * axis);
  }
};

constexpr unsigned kLasFormats = 11;

/// Bytes of a record of a point format of 0 ... 10, without extra bytes.
std::size_t las_format_bytes(unsigned format);

/// The fields of a point format, X, Y and Z first, and whether one has that name.
std::vector<LasField> las_standard_fields(unsigned format);
bool las_format_has(unsigned format, std::string_view field);

/// The extra bytes of the file's records, as its record LASF_Spec 4 describes them: unique names
/// (edge_class, p_sharp and p_smooth as scalar_...); bytes that it does not describe are
/// ExtraBytes.
std::vector<LasField> las_extra_fields(const LasFile& file, std::vector<std::string>& warnings);

/// The 192 bytes that describe an extra field.
std::string las_extra_descriptor(const LasField& field);

/// Reads everything but the points; harmless faults become warnings. Records of COPC, which index
/// the compressed points, are left out. Throws Error(kUnreadable), naming the byte, for other
/// faults.
LasFile read_las_file(const InputFile& file, std::vector<std::string>& warnings);

/// The latest end of the points: the records behind them, or the end of the file.
std::uint64_t las_points_limit(const InputFile& file, const LasFile& las);

/// All records, extended ones last.
std::vector<const LasRecord*> all_records(const LasFile& file);

/// From its WKT, otherwise from its GeoTIFF keys; never asks PROJ.
CoordinateSystem coordinate_system_of(const LasFile& file);

/// Whether the records name a system, with a code or without; and one of heights.
bool names_system(const LasFile& file);
bool names_heights(const LasFile& file);

/// Sets the beginning of the extended records in the header to `begin`; false if it has no field
/// for it.
bool place_extended_records(LasFile& file, std::uint64_t begin);

/// The records as bytes of a file.
std::string las_record_bytes(const std::vector<LasRecord>& records, bool extended);

/// Stores header and records in a cloud, as elements that PLY files carry too; and takes them out
/// again: a file with an empty header if the cloud has no valid ones.
void attach_las_file(PointCloud& cloud, const LasFile& file);
LasFile attached_las_file(const PointCloud& cloud);
bool is_las_element(const ForeignElement& element);

}  // namespace pcednet::io
