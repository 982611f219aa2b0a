#include "pcednet/io/las/file.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

namespace pcednet::io {
namespace {

constexpr std::size_t kLeastHeader = 227, kHeader13 = 235, kHeader14 = 375, kHeader15 = 393;
constexpr unsigned kMostMinor = 5;
constexpr const char* kElements[] = {"las_header", "las_vlrs", "las_evlrs", "las_before_points"};

std::size_t header_bytes_of(bool extended) {
  return extended ? 60 : 54;
}

std::string until_zero(std::string_view text) {
  return std::string(text.substr(0, text.find('\0')));
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
    const std::uint64_t length =
        extended ? number_at<std::uint64_t>(bytes, 20) : number_at<std::uint16_t>(bytes, 20);
    if (bytes.empty() || length > room - head) {
      warnings.push_back(fmt::format("{} of {} {} fit before byte {}: the others are left out", i,
                                     count, kind, end));
      break;
    }
    const std::string_view view = bytes;
    records.push_back({until_zero(view.substr(2, 16)), number_at<std::uint16_t>(view, 18),
                       until_zero(view.substr(head - 32, 32)), file.text(begin + head, length),
                       bytes});
    begin += head + length;
  }
  return records;
}

void check_header(const InputFile& file, LasFile& las) {
  const auto fail = [&](std::size_t byte, const std::string& what) {
    throw unreadable(file.path(), fmt::format("byte {}: {}", byte, what));
  };
  const std::string& header = las.header;
  if (header.size() < kLeastHeader) fail(header.size(), "ends within the LAS header");
  const unsigned major = number_at<std::uint8_t>(header, 24);
  if (major != 1 || las.minor_version() > kMostMinor) {
    fail(24,
         fmt::format("LAS {}.{}; 1.0 to 1.{} are read", major, las.minor_version(), kMostMinor));
  }
  if (las.point_format() >= kLasFormats) {
    fail(104, fmt::format("point format {}; 0 to 10 are read", las.point_format()));
  }
  if (las.record_length() < las_format_bytes(las.point_format())) {
    fail(105, fmt::format("points of {} bytes; format {} needs {}", las.record_length(),
                          las.point_format(), las_format_bytes(las.point_format())));
  }
  for (std::size_t axis = 0; axis < 3; ++axis) {
    const double scale = las.scale(axis);
    if (!std::isfinite(scale) || scale == 0.0) {
      fail(131 + 8 * axis, fmt::format("a scale of {}", scale));
    }
    if (!std::isfinite(las.offset(axis))) {
      fail(155 + 8 * axis, fmt::format("an offset of {}", las.offset(axis)));
    }
  }
}

/// The extended records: as many as LAS 1.4 counts, or only that of the waveforms (LAS 1.3).
void read_extended(const InputFile& file, LasFile& las, std::vector<std::string>& warnings) {
  if (las.minor_version() < 3) return;
  auto begin = number_at<std::uint64_t>(las.header, 227);
  std::uint32_t count = begin > 0 ? 1 : 0;
  if (las.counts_wide() && number_at<std::uint32_t>(las.header, 243) > 0) {
    begin = number_at<std::uint64_t>(las.header, 235);
    count = number_at<std::uint32_t>(las.header, 243);
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
    const std::uint64_t length =
        extended ? number_at<std::uint64_t>(bytes, 20) : number_at<std::uint16_t>(bytes, 20);
    if (length > bytes.size() - head) break;
    records.push_back({until_zero(bytes.substr(2, 16)), number_at<std::uint16_t>(bytes, 18),
                       until_zero(bytes.substr(head - 32, 32)),
                       std::string(bytes.substr(head, length)),
                       std::string(bytes.substr(0, head))});
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

bool LasFile::counts_wide() const {
  return minor_version() >= 4 && header.size() >= kHeader14;
}

bool LasFile::has_time_range() const {
  return minor_version() >= 5 && header.size() >= kHeader15;
}

std::uint64_t LasFile::point_count() const {
  const std::uint64_t wide = counts_wide() ? number_at<std::uint64_t>(header, 247) : 0;
  return wide > 0 ? wide : number_at<std::uint32_t>(header, 107);
}

void LasFile::set_point_count(std::uint64_t count) {
  const bool narrow = (point_format() < 6 || !counts_wide()) && count <= UINT32_MAX;
  put_number(header, 107, static_cast<std::uint32_t>(narrow ? count : 0));
  if (counts_wide()) put_number(header, 247, count);
}

bool begins_as_las(std::string_view start) {
  return start.starts_with("LASF");
}

LasFile read_las_file(const InputFile& file, std::vector<std::string>& warnings) {
  LasFile las;
  las.header = file.text(0, kLeastHeader);
  if (!begins_as_las(las.header)) {
    throw unreadable(file.path(), "not a LAS file: it must begin with LASF");
  }
  const std::size_t promised = number_at<std::uint16_t>(las.header, 94);
  const unsigned minor = las.minor_version();
  const std::size_t needed = minor >= 5 ? kHeader15 : minor == 4 ? kHeader14 : kLeastHeader;
  if (las.header.size() == kLeastHeader && promised < needed) {
    warnings.push_back(fmt::format("the header calls itself {} bytes, version 1.{} has {}",
                                   promised, minor, needed));
  }
  las.header = file.text(0, std::max(promised, kLeastHeader));
  check_header(file, las);
  const auto narrow = number_at<std::uint32_t>(las.header, 107);
  if (narrow > 0 && narrow != las.point_count()) {
    warnings.push_back(fmt::format("the header counts {} points and, in 64 bits, {}: these hold",
                                   narrow, las.point_count()));
  }
  const std::uint64_t end = las.points_offset();
  if (end < las.header.size() || end > file.size()) {
    throw unreadable(file.path(),
                     fmt::format("byte 96: points from byte {} on, of {}", end, file.size()));
  }
  std::uint64_t at = las.header.size();
  las.records =
      read_records(file, at, end, number_at<std::uint32_t>(las.header, 100), false, warnings);
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
  if (las.minor_version() >= 3) stop_at(number_at<std::uint64_t>(las.header, 227));
  if (las.counts_wide()) stop_at(number_at<std::uint64_t>(las.header, 235));
  return limit;
}

bool place_extended_records(LasFile& file, std::uint64_t begin) {
  if (file.minor_version() < 3 || file.header.size() < kHeader13) return false;
  std::uint64_t waves = 0, at = begin;
  for (const LasRecord& record : file.extended_records) {
    if (record.is("LASF_Spec", 65535)) waves = at;
    at += header_bytes_of(true) + record.data.size();
  }
  put_number(file.header, 227, waves);
  if (!file.counts_wide()) return true;
  put_number<std::uint64_t>(file.header, 235, file.extended_records.empty() ? 0 : begin);
  put_number(file.header, 243, static_cast<std::uint32_t>(file.extended_records.size()));
  return true;
}

std::string las_record_bytes(const std::vector<LasRecord>& records, bool extended) {
  std::string bytes;
  for (const LasRecord& record : records) {
    std::string head = record.head;
    if (head.size() != header_bytes_of(extended)) {
      head.assign(header_bytes_of(extended), '\0');
      head.replace(2, 16, fixed(record.user_id, 16));
      put_number(head, 18, record.record_id);
      head.replace(head.size() - 32, 32, fixed(record.description, 32));
    }
    if (extended) {
      put_number<std::uint64_t>(head, 20, record.data.size());
    } else {
      put_number(head, 20, static_cast<std::uint16_t>(record.data.size()));
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
  const bool sound = file.header.size() >= kLeastHeader && file.header.size() <= UINT16_MAX &&
                     file.minor_version() <= kMostMinor && file.point_format() < kLasFormats &&
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
