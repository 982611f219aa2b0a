#include "pcednet/io/las/file.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <utility>

namespace pcednet::io {
namespace {

constexpr unsigned kMostMinor = 5;
constexpr const char* kElements[] = {"las_header", "las_vlrs", "las_evlrs", "las_before_points"};

std::size_t header_bytes_of(bool extended) {
  return extended ? las_record::kExtendedHeadBytes : las_record::kHeadBytes;
}

std::uint64_t data_length(std::string_view head, bool extended) {
  return extended ? number_at<std::uint64_t>(head, las_record::kLength)
                  : number_at<std::uint16_t>(head, las_record::kLength);
}

LasRecord make_record(std::string_view head, std::string data) {
  const std::size_t description = head.size() - las_record::kDescriptionBytes;
  return {until_zero(head.substr(las_record::kUserId, las_record::kUserIdBytes)),
          number_at<std::uint16_t>(head, las_record::kRecordId),
          until_zero(head.substr(description)), std::move(data), std::string(head)};
}

/// The records from `begin` on, which moves behind them; those that leave [begin, end) are left out
/// with a warning.
std::vector<LasRecord> read_records(const InputFile& file, std::uint64_t& begin, std::uint64_t end,
                                    std::uint64_t count, bool extended,
                                    std::vector<std::string>& warnings) {
  const std::size_t head = header_bytes_of(extended);
  const char* kind = extended ? "extended variable length records" : "variable length records";
  std::vector<LasRecord> records;
  for (std::uint64_t i = 0; i < count; ++i) {
    const std::uint64_t room = end - std::min(begin, end);
    const std::string bytes = room < head ? "" : file.text(begin, head);
    const std::uint64_t length = data_length(bytes, extended);
    if (bytes.empty() || length > room - head) {
      warnings.push_back(fmt::format("only {} of {} {} fit before byte {}: the others are left out",
                                     i, count, kind, end));
      break;
    }
    records.push_back(make_record(bytes, file.text(begin + head, length)));
    begin += head + length;
  }
  return records;
}

void check_header(const InputFile& file, LasFile& las) {
  const auto fail = [&](std::size_t byte, const std::string& what) {
    throw unreadable(file.path(), fmt::format("byte {}: {}", byte, what));
  };
  const std::string& header = las.header;
  if (header.size() < las_header::kLeastBytes) fail(header.size(), "ends within the LAS header");
  const unsigned major = number_at<std::uint8_t>(header, las_header::kMajorVersion);
  if (major != 1 || las.minor_version() > kMostMinor) {
    fail(las_header::kMajorVersion,
         fmt::format("LAS {}.{}; 1.0 to 1.{} are read", major, las.minor_version(), kMostMinor));
  }
  if (las.point_format() >= kLasFormats) {
    fail(las_header::kPointFormat,
         fmt::format("point format {}; 0 to 10 are read", las.point_format()));
  }
  if (las.record_length() < las_format_bytes(las.point_format())) {
    fail(las_header::kRecordLength,
         fmt::format("points of {} bytes; format {} needs {}", las.record_length(),
                     las.point_format(), las_format_bytes(las.point_format())));
  }
  for (std::size_t axis = 0; axis < 3; ++axis) {
    const double scale = las.scale(axis);
    if (!std::isfinite(scale) || scale == 0.0) {
      fail(las_header::kScales + 8 * axis, fmt::format("a scale of {}", scale));
    }
    if (!std::isfinite(las.offset(axis))) {
      fail(las_header::kOffsets + 8 * axis, fmt::format("an offset of {}", las.offset(axis)));
    }
  }
}

/// The extended records: as many as LAS 1.4 counts, or only that of the waveforms (LAS 1.3).
void read_extended(const InputFile& file, LasFile& las, std::vector<std::string>& warnings) {
  if (las.minor_version() < 3) return;
  auto begin = number_at<std::uint64_t>(las.header, las_header::kWaveforms);
  std::uint32_t count = begin > 0 ? 1 : 0;
  if (las.counts_wide() && number_at<std::uint32_t>(las.header, las_header::kExtendedCount) > 0) {
    begin = number_at<std::uint64_t>(las.header, las_header::kExtendedRecords);
    count = number_at<std::uint32_t>(las.header, las_header::kExtendedCount);
  }
  if (count == 0) return;
  if (begin < las.points_offset()) {
    warnings.push_back(fmt::format(
        "extended variable length records at byte {}, before the points: left out", begin));
    return;
  }
  las.extended_records = read_records(file, begin, file.size(), count, true, warnings);
}

std::string fixed(std::string_view text, std::size_t size) {
  std::string bytes(size, '\0');
  text.copy(bytes.data(), size);
  return bytes;
}

ForeignElement to_element(const char* name, std::string_view bytes) {
  const auto* first = reinterpret_cast<const std::byte*>(bytes.data());
  return {fmt::format("element {} {}\nproperty uchar byte\n", name, bytes.size()),
          {first, first + bytes.size()}};
}

/// The records of bytes that attach_las_file wrote.
std::vector<LasRecord> parse_records(std::string_view bytes, bool extended) {
  const std::size_t head = header_bytes_of(extended);
  std::vector<LasRecord> records;
  while (bytes.size() >= head) {
    const std::uint64_t length = data_length(bytes, extended);
    if (length > bytes.size() - head) break;
    records.push_back(make_record(bytes.substr(0, head), std::string(bytes.substr(head, length))));
    bytes.remove_prefix(head + length);
  }
  return records;
}

std::string element_bytes(const PointCloud& cloud, const std::string& name) {
  for (const ForeignElement& element : cloud.foreign_elements) {
    if (!element.header.starts_with("element " + name + " ")) continue;
    return {reinterpret_cast<const char*>(element.bytes.data()), element.bytes.size()};
  }
  return {};
}

}  // namespace

LasRecord new_record(const LasRecordKind& kind, std::string description, std::string data) {
  return {std::string(kind.user_id), kind.record_id, std::move(description), std::move(data)};
}

const LasRecord* find_record(const std::vector<LasRecord>& records, const LasRecordKind& kind) {
  const auto found = std::find_if(records.begin(), records.end(),
                                  [&](const LasRecord& record) { return record.is(kind); });
  return found == records.end() ? nullptr : &*found;
}

LasRecord* find_record(std::vector<LasRecord>& records, const LasRecordKind& kind) {
  return const_cast<LasRecord*>(find_record(std::as_const(records), kind));
}

std::vector<const LasRecord*> all_records(const LasFile& file) {
  std::vector<const LasRecord*> all;
  for (const LasRecord& record : file.records) all.push_back(&record);
  for (const LasRecord& record : file.extended_records) all.push_back(&record);
  return all;
}

bool LasFile::counts_wide() const {
  return minor_version() >= 4 && header.size() >= las_header::kBytes14;
}

bool LasFile::has_time_range() const {
  return minor_version() >= 5 && header.size() >= las_header::kBytes15;
}

std::uint64_t LasFile::point_count() const {
  const std::uint64_t wide =
      counts_wide() ? number_at<std::uint64_t>(header, las_header::kPointCount64) : 0;
  return wide > 0 ? wide : number_at<std::uint32_t>(header, las_header::kPointCount32);
}

void LasFile::set_point_count(std::uint64_t count) {
  const bool narrow = (point_format() < 6 || !counts_wide()) && count <= UINT32_MAX;
  put_number(header, las_header::kPointCount32, static_cast<std::uint32_t>(narrow ? count : 0));
  if (counts_wide()) put_number(header, las_header::kPointCount64, count);
}

bool begins_as_las(std::string_view start) {
  return start.starts_with("LASF");
}

LasFile read_las_file(const InputFile& file, std::vector<std::string>& warnings) {
  LasFile las;
  las.header = file.text(0, las_header::kLeastBytes);
  if (!begins_as_las(las.header)) {
    throw unreadable(file.path(), "not a LAS file: it must begin with LASF");
  }
  const std::size_t promised = number_at<std::uint16_t>(las.header, las_header::kHeaderBytes);
  const unsigned minor = las.minor_version();
  const std::size_t needed = minor >= 5   ? las_header::kBytes15
                             : minor == 4 ? las_header::kBytes14
                                          : las_header::kLeastBytes;
  if (las.header.size() == las_header::kLeastBytes && promised < needed) {
    warnings.push_back(fmt::format("the header declares its size as {} bytes; version 1.{} has {}",
                                   promised, minor, needed));
  }
  las.header = file.text(0, std::max(promised, las_header::kLeastBytes));
  check_header(file, las);
  const auto narrow = number_at<std::uint32_t>(las.header, las_header::kPointCount32);
  if (narrow > 0 && narrow != las.point_count()) {
    warnings.push_back(
        fmt::format("the header counts {} points and, in 64 bits, {}: the 64-bit count is used",
                    narrow, las.point_count()));
  }
  const std::uint64_t end = las.points_offset();
  if (end < las.header.size() || end > file.size()) {
    throw unreadable(file.path(),
                     fmt::format("byte {}: the points begin at byte {}, but the header ends at "
                                 "byte {} and the file at byte {}",
                                 las_header::kPointsOffset, end, las.header.size(), file.size()));
  }
  std::uint64_t at = las.header.size();
  las.records =
      read_records(file, at, end, number_at<std::uint32_t>(las.header, las_header::kRecordCount),
                   false, warnings);
  las.before_points = file.text(at, end - at);
  read_extended(file, las, warnings);
  if (las.compressed()) {
    const auto is_copc = [](const LasRecord& record) { return record.user_id == "copc"; };
    std::erase_if(las.records, is_copc);
    std::erase_if(las.extended_records, is_copc);
  }
  return las;
}

std::uint64_t las_points_limit(const InputFile& file, const LasFile& las) {
  std::uint64_t limit = file.size();
  const auto stop_at = [&](std::uint64_t begin) {
    if (begin >= las.points_offset()) limit = std::min(limit, begin);
  };
  if (las.minor_version() >= 3) {
    stop_at(number_at<std::uint64_t>(las.header, las_header::kWaveforms));
  }
  if (las.counts_wide())
    stop_at(number_at<std::uint64_t>(las.header, las_header::kExtendedRecords));
  return limit;
}

bool place_extended_records(LasFile& file, std::uint64_t begin) {
  if (file.minor_version() < 3 || file.header.size() < las_header::kBytes13) return false;
  std::uint64_t waves = 0, at = begin;
  for (const LasRecord& record : file.extended_records) {
    if (record.is(kWaveformsRecord)) waves = at;
    at += header_bytes_of(true) + record.data.size();
  }
  put_number(file.header, las_header::kWaveforms, waves);
  if (!file.counts_wide()) return true;
  put_number<std::uint64_t>(file.header, las_header::kExtendedRecords,
                            file.extended_records.empty() ? 0 : begin);
  put_number(file.header, las_header::kExtendedCount,
             static_cast<std::uint32_t>(file.extended_records.size()));
  return true;
}

std::string las_record_bytes(const std::vector<LasRecord>& records, bool extended) {
  std::string bytes;
  for (const LasRecord& record : records) {
    std::string head = record.head;
    if (head.size() != header_bytes_of(extended)) {
      head.assign(header_bytes_of(extended), '\0');
      using namespace las_record;
      head.replace(kUserId, kUserIdBytes, fixed(record.user_id, kUserIdBytes));
      put_number(head, kRecordId, record.record_id);
      head.replace(head.size() - kDescriptionBytes, kDescriptionBytes,
                   fixed(record.description, kDescriptionBytes));
    }
    if (extended) {
      put_number<std::uint64_t>(head, las_record::kLength, record.data.size());
    } else {
      put_number(head, las_record::kLength, static_cast<std::uint16_t>(record.data.size()));
    }
    bytes += head + record.data;
  }
  return bytes;
}

void attach_las_file(PointCloud& cloud, const LasFile& file) {
  auto& elements = cloud.foreign_elements;
  std::erase_if(elements, is_las_element);
  elements.push_back(to_element(kElements[0], file.header));
  if (!file.records.empty()) {
    elements.push_back(to_element(kElements[1], las_record_bytes(file.records, false)));
  }
  if (!file.extended_records.empty()) {
    elements.push_back(to_element(kElements[2], las_record_bytes(file.extended_records, true)));
  }
  if (!file.before_points.empty()) {
    elements.push_back(to_element(kElements[3], file.before_points));
  }
}

LasFile attached_las_file(const PointCloud& cloud) {
  LasFile file;
  file.header = element_bytes(cloud, kElements[0]);
  const bool sound = file.header.size() >= las_header::kLeastBytes &&
                     file.header.size() <= UINT16_MAX && file.minor_version() <= kMostMinor &&
                     file.point_format() < kLasFormats &&
                     file.record_length() >= las_format_bytes(file.point_format());
  if (!sound) return {};
  for (std::size_t axis = 0; axis < 3; ++axis) {
    if (!std::isfinite(file.scale(axis)) || file.scale(axis) == 0.0) return {};
    if (!std::isfinite(file.offset(axis))) return {};
  }
  file.records = parse_records(element_bytes(cloud, kElements[1]), false);
  file.extended_records = parse_records(element_bytes(cloud, kElements[2]), true);
  file.before_points = element_bytes(cloud, kElements[3]);
  return file;
}

bool is_las_element(const ForeignElement& element) {
  return element.header.starts_with("element las_");
}

}  // namespace pcednet::io
