#pragma once

#include <array>
#include <cstdint>
#include <string>
#include <vector>

#include "io/scratch.h"
#include "pcednet/core/random.h"

namespace pcednet::io {

struct LasTestRecord {
  std::string user;
  unsigned id = 0;
  std::string data = {}, description = {};
  unsigned reserved = 0;
};

/// A LAS file to write, from the tables of the standard. What is not given is worked out.
struct LasTestFile {
  unsigned format = 6, minor = 4;
  std::string rows = {};
  std::size_t extra = 0;  ///< bytes of a point beyond those of the format
  std::vector<LasTestRecord> records = {}, extended = {};
  std::string before_points = {};  ///< bytes that belong to no record
  unsigned time_offset = 1000;     ///< of LAS 1.5
  std::array<double, 3> scale = {0.001, 0.001, 0.0005}, offset = {652000.0, 6862000.0, -20.0};
};

inline std::size_t las_test_stride(unsigned format, std::size_t extra = 0) {
  constexpr std::size_t kBytes[] = {20, 28, 26, 34, 57, 63, 30, 36, 38, 59, 67};
  return kBytes[format] + extra;
}

inline std::size_t las_test_header(unsigned minor) {
  return minor < 3 ? 227 : minor == 3 ? 235 : minor == 4 ? 375 : 393;
}

template <typename T>
void set_number(std::string& bytes, std::size_t at, T value) {
  bytes.replace(at, sizeof value, packed(value));
}

template <typename T>
T get_number(std::string_view bytes, std::size_t at) {
  T value = {};
  std::memcpy(&value, bytes.substr(at, sizeof value).data(), sizeof value);
  return value;
}

inline std::string las_test_record(const LasTestRecord& record, bool extended) {
  std::string user = record.user, description = record.description;
  user.resize(16);
  description.resize(32);
  return packed(static_cast<std::uint16_t>(record.reserved)) + user +
         packed(static_cast<std::uint16_t>(record.id)) +
         (extended ? packed(std::uint64_t{record.data.size()})
                   : packed(static_cast<std::uint16_t>(record.data.size()))) +
         description + record.data;
}

/// One of the 192-byte descriptors in the record LASF_Spec 4; `options` counts the bytes of type 0.
inline std::string las_test_extra(const std::string& name, unsigned type, unsigned options = 0) {
  std::string bytes(192, '\0');
  bytes[2] = static_cast<char>(type);
  bytes[3] = static_cast<char>(options);
  return bytes.replace(4, name.size(), name);
}

inline unsigned las_test_return(const LasTestFile& file, std::size_t point) {
  const std::size_t stride = las_test_stride(file.format, file.extra);
  return static_cast<std::uint8_t>(file.rows[point * stride + 14]) & (file.format < 6 ? 7U : 15U);
}

/// Where the record of the waveforms begins; 0 if there is none.
inline std::uint64_t las_test_waves(const LasTestFile& file, std::uint64_t at) {
  for (const LasTestRecord& record : file.extended) {
    if (record.user == "LASF_Spec" && record.id == 65535) return at;
    at += 60 + record.data.size();
  }
  return 0;
}

/// What LAS 1.5 adds to the header: the largest and the least time, and the offset of all.
inline std::string las_test_times(const LasTestFile& file, std::size_t points) {
  const std::size_t stride = las_test_stride(file.format, file.extra);
  const bool timed = file.format != 0 && file.format != 2;
  double least = 0.0, largest = 0.0;
  for (std::size_t i = 0; timed && i < points; ++i) {
    const auto time = get_number<double>(file.rows, i * stride + (file.format < 6 ? 20 : 22));
    least = i == 0 ? time : std::min(least, time);
    largest = i == 0 ? time : std::max(largest, time);
  }
  return packed(largest, least, static_cast<std::uint16_t>(file.time_offset));
}

/// The header, as the standard has it.
inline std::string las_test_header_bytes(const LasTestFile& file, std::size_t records_size) {
  const std::size_t size = las_test_header(file.minor);
  const std::size_t stride = las_test_stride(file.format, file.extra);
  const std::size_t points = file.rows.size() / stride;
  const bool narrow = file.format < 6 || file.minor < 4;
  std::string header = "LASF" + packed(std::uint16_t{7}, std::uint16_t{0}) + "16 bytes of GUID";
  header += packed(std::uint8_t{1}, static_cast<std::uint8_t>(file.minor));
  header += "a scanner of some kind" + std::string(10, '\0');
  header += "a program" + std::string(23, '\0');
  header += packed(std::uint16_t{100}, std::uint16_t{2020}, static_cast<std::uint16_t>(size),
                   static_cast<std::uint32_t>(size + records_size),
                   static_cast<std::uint32_t>(file.records.size()),
                   static_cast<std::uint8_t>(file.format), static_cast<std::uint16_t>(stride),
                   static_cast<std::uint32_t>(narrow ? points : 0));
  std::array<std::uint64_t, 15> returns = {};
  std::array<double, 3> least = {}, largest = {};
  for (std::size_t i = 0; i < points; ++i) {
    const unsigned number = las_test_return(file, i);
    if (number > 0) ++returns[number - 1];
    for (std::size_t a = 0; a < 3; ++a) {
      const double value =
          get_number<std::int32_t>(file.rows, i * stride + 4 * a) * file.scale[a] + file.offset[a];
      least[a] = i == 0 ? value : std::min(least[a], value);
      largest[a] = i == 0 ? value : std::max(largest[a], value);
    }
  }
  for (std::size_t r = 0; r < 5; ++r) {
    header += packed(static_cast<std::uint32_t>(narrow ? returns[r] : 0));
  }
  for (const double scale : file.scale) header += packed(scale);
  for (const double offset : file.offset) header += packed(offset);
  for (std::size_t a = 0; a < 3; ++a) header += packed(largest[a], least[a]);
  const std::uint64_t end = size + records_size + file.rows.size();
  if (file.minor >= 3) header += packed(las_test_waves(file, end));
  if (file.minor < 4) return header;
  header += packed(file.extended.empty() ? 0 : end,
                   static_cast<std::uint32_t>(file.extended.size()), std::uint64_t{points});
  for (const std::uint64_t count : returns) header += packed(count);
  if (file.minor >= 5) header += las_test_times(file, points);
  return header;
}

inline std::string las_bytes(const LasTestFile& file) {
  std::string records, extended;
  for (const LasTestRecord& record : file.records) records += las_test_record(record, false);
  for (const LasTestRecord& record : file.extended) extended += las_test_record(record, true);
  records += file.before_points;
  return las_test_header_bytes(file, records.size()) + records + file.rows + extended;
}

/// Records as a scanner makes them: lines over a fold, times that step and jump; the other bytes
/// now and then change to anything. Scanner channels of formats 6 to 10: 0 ... `channels` - 1.
inline std::string las_test_rows(unsigned format, std::size_t points, std::size_t extra = 0,
                                 unsigned channels = 1, std::uint64_t seed = 1) {
  const std::size_t stride = las_test_stride(format, extra);
  const std::size_t time_at = format == 0 || format == 2 ? 0 : format < 6 ? 20 : 22;
  Random random(seed);
  std::string rows(points * stride, '\0'), row(stride, '\0');
  double time = 3.0e8;
  for (std::size_t i = 0; i < points; ++i) {
    for (std::size_t b = 12; b < stride; ++b) {
      if (random.index(12) == 0) row[b] = static_cast<char>(random.next());
    }
    const auto across = static_cast<std::int32_t>(i % 250),
               along = static_cast<std::int32_t>(i / 250);
    const auto noise = [&] { return static_cast<std::int32_t>(random.index(7)); };
    set_number(row, 0, 100 * across + noise());
    set_number(row, 4, 100 * along + noise());
    set_number(row, 8, 160 * std::abs(across - 125) + noise());
    if (random.index(500) == 0) set_number(row, 4, static_cast<std::int32_t>(random.next()));
    if (time_at > 0) {
      const std::size_t kind = random.index(40);
      if (kind > 8) time += 1e-5 * static_cast<double>(1 + random.index(3));
      if (kind == 0) time += random.uniform(-1e5, 1e5);
      set_number(row, time_at, time);
    }
    if (format >= 6) {
      const unsigned flags = static_cast<std::uint8_t>(row[15]) & 0xCFU;
      row[15] = static_cast<char>(flags | static_cast<unsigned>(random.index(channels)) << 4U);
    }
    rows.replace(i * stride, stride, row);
  }
  return rows;
}

}  // namespace pcednet::io
