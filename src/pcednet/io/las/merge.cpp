#include "pcednet/io/las/merge.h"

#include <algorithm>
#include <set>
#include <string_view>

#include "pcednet/io/projection.h"

namespace pcednet::io {
namespace {

/// Whether the records' coordinate system, if any, is given as WKT, which is added where there are
/// only codes.
bool name_system_in_wkt(LasFile& file) {
  bool keys = false;
  for (const LasRecord* record : all_records(file)) {
    if (record->is(kWktRecord)) return true;
    constexpr std::size_t kBytesBeforeKeys = 8;
    keys = keys || (record->is(kGeoKeysRecord) && record->data.size() > kBytesBeforeKeys);
  }
  if (!keys) return true;
  const std::string wkt = definition_of(coordinate_system_of(file), WktVersion::k1);
  if (wkt.empty() || wkt.size() >= UINT16_MAX) return false;
  file.records.push_back(new_record(kWktRecord, "OGC WKT of the GeoTIFF keys", wkt + '\0'));
  return true;
}

unsigned encoding_of(const LasFile& file) {
  return number_at<std::uint16_t>(file.header, las_header::kGlobalEncoding);
}

/// Takes the bits of `mask` from `encoding`.
void set_encoding(LasFile& file, unsigned encoding, unsigned mask) {
  const unsigned set = (encoding_of(file) & ~mask) | (encoding & mask);
  put_number(file.header, las_header::kGlobalEncoding, static_cast<std::uint16_t>(set));
}

unsigned common_format(std::span<const LasFile> files) {
  const unsigned first = files.front().point_format();
  const auto any = [&](auto&& is_so) { return std::ranges::any_of(files, is_so); };
  const auto any_has = [&](const char* field) {
    return any([&](const LasFile& file) { return las_format_has(file.point_format(), field); });
  };
  if (!any([&](const LasFile& file) { return file.point_format() != first; })) return first;
  const bool colours = any_has("Red");
  if (any([](const LasFile& file) { return file.point_format() >= 6; })) {
    if (any_has("Infrared")) return 8;
    return colours ? 7 : 6;
  }
  const bool times = any_has("GpsTime");
  return (colours ? 2 : 0) + (times ? 1 : 0);
}

/// The extra bytes of all, one after the other.
struct ExtraBytes {
  std::string descriptors = {};
  std::size_t bytes = 0;
};

ExtraBytes extra_bytes_of(std::span<const LasFile> files) {
  ExtraBytes all;
  std::set<std::string> names;
  std::vector<std::string> known;
  for (const LasFile& file : files) {
    const LasRecord* const record = find_record(file.records, kExtraBytesRecord);
    for (const LasField& field : las_extra_fields(file, known)) {
      if (!field.descriptor || !names.insert(field.name).second) continue;
      all.descriptors += record->data.substr(*field.descriptor, las_descriptor::kBytes);
      all.bytes += field.components * size_of(field.type);
    }
  }
  return all;
}

void set_extra_bytes(const ExtraBytes& extra, LasFile& file) {
  if (extra.descriptors.empty()) return;
  if (LasRecord* const record = find_record(file.records, kExtraBytesRecord)) {
    record->data = extra.descriptors;
  } else {
    file.records.push_back(new_record(kExtraBytesRecord, "extra bytes", extra.descriptors));
  }
}

bool is_of_system(const LasRecord& record) {
  return record.user_id == kWktRecord.user_id;
}

/// Takes the records of the file that names most of the coordinate system.
void take_system(std::span<const LasFile> files, LasFile& merged) {
  auto fullest = std::ranges::find_if(files, names_heights);
  if (fullest == files.end()) fullest = std::ranges::find_if(files, names_system);
  if (fullest == files.end() || fullest == files.begin()) return;
  std::erase_if(merged.records, is_of_system);
  std::erase_if(merged.extended_records, is_of_system);
  for (const LasRecord* record : all_records(*fullest)) {
    if (!is_of_system(*record)) continue;
    const bool fits = record->data.size() <= UINT16_MAX;  // its length, of 16 bits
    (fits ? merged.records : merged.extended_records).push_back(*record);
  }
  set_encoding(merged, encoding_of(*fullest), las_header::kWktBit);
}

}  // namespace

LasFile merge_las_files(std::span<const LasFile> files, std::size_t timed) {
  LasFile merged = files.front();
  take_system(files, merged);
  set_encoding(merged, encoding_of(files[timed]), las_header::kStandardTimeBit);
  const unsigned format = common_format(files);
  const ExtraBytes extra = extra_bytes_of(files);
  if (format >= 6 && merged.point_format() < 6) {
    promote_las(merged, format);
  } else if (format != merged.point_format()) {
    put_number(merged.header, las_header::kPointFormat, static_cast<std::uint8_t>(format));
    const unsigned least = format >= 2 ? 2 : 0;  // the version that brought the format
    put_number(merged.header, las_header::kMinorVersion,
               static_cast<std::uint8_t>(std::max(merged.minor_version(), least)));
  }
  put_number(merged.header, las_header::kRecordLength,
             static_cast<std::uint16_t>(las_format_bytes(format) + extra.bytes));
  set_extra_bytes(extra, merged);
  return merged;
}

std::vector<std::string> promote_las(LasFile& file, unsigned format) {
  std::vector<std::string> losses;
  const std::size_t own = las_format_bytes(file.point_format());
  const std::size_t extra = std::max(file.record_length(), own) - own;
  unsigned encoding = file.minor_version() < 2 ? 0 : encoding_of(file);  // had no meaning yet
  if (file.has_time_range() && (encoding & las_header::kTimeOffsetBit) != 0) {
    losses.emplace_back("the offset of all times, which LAS 1.5 has");
  }
  encoding &= ~(las_header::kTimeOffsetBit | las_header::kWktBit);
  if (name_system_in_wkt(file)) {
    encoding |= las_header::kWktBit;
  } else {
    losses.emplace_back(
        has_projections() ? "the coordinate system as WKT: its GeoTIFF keys, which are kept, name "
                            "none that PROJ knows"
                          : "the coordinate system as WKT (without PROJ): only its GeoTIFF "
                            "keys are kept");
  }
  file.header.resize(las_header::kBytes14);
  put_number(file.header, las_header::kGlobalEncoding, static_cast<std::uint16_t>(encoding));
  put_number<std::uint8_t>(file.header, las_header::kMinorVersion, 4);
  put_number(file.header, las_header::kPointFormat, static_cast<std::uint8_t>(format));
  put_number(file.header, las_header::kRecordLength,
             static_cast<std::uint16_t>(las_format_bytes(format) + extra));
  return losses;
}

}  // namespace pcednet::io
