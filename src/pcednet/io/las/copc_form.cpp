#include <algorithm>

#include "pcednet/io/las/copc.h"
#include "pcednet/io/projection.h"
#include "pcednet/io/text_scan.h"

namespace pcednet::io {
namespace {

bool has_field(unsigned format, const char* name) {
  const std::vector<LasField> fields = las_standard_fields(format);
  return std::any_of(fields.begin(), fields.end(),
                     [&](const LasField& f) { return f.name == name; });
}

/// The point format of COPC with the colours of `format`.
unsigned copc_format(unsigned format, const PointCloud& first) {
  if (has_field(format, "Infrared")) return 8;
  if (!has_field(format, "Red")) return 6;
  const Attribute* infrared = find_attribute(first, "Infrared");
  return infrared && infrared->type == ScalarType::kUint16 ? 8 : 7;
}

/// Whether the records' coordinate system, if any, is given as WKT, which is added where there are
/// only codes.
bool name_system_in_wkt(LasFile& file) {
  bool keys = false;
  for (const auto* records : {&file.records, &file.extended_records}) {
    for (const LasRecord& record : *records) {
      if (record.is(kWktRecord)) return true;
      constexpr std::size_t kBytesBeforeKeys = 8;
      keys = keys || (record.is(kGeoKeysRecord) && record.data.size() > kBytesBeforeKeys);
    }
  }
  if (!keys) return true;
  const std::string wkt = definition_of(coordinate_system_of(file), WktVersion::k1);
  if (wkt.empty() || wkt.size() >= UINT16_MAX) return false;
  file.records.push_back(new_record(kWktRecord, "OGC WKT of the GeoTIFF keys", wkt + '\0'));
  return true;
}

}  // namespace

bool is_copc_name(const std::filesystem::path& path) {
  return lower_case(path.filename().string()).ends_with(".copc.laz");
}

void choose_copc(LasChoices& choices, const PointCloud& first) {
  LasFile& file = choices.file;
  const unsigned before = file.point_format(), format = copc_format(before, first);
  const std::size_t extra =
      file.record_length() == 0 ? 0 : file.record_length() - las_format_bytes(before);
  unsigned encoding = number_at<std::uint16_t>(file.header, las_header::kGlobalEncoding);
  if (file.minor_version() < 2) encoding = 0;  // had no meaning yet
  if (file.has_time_range() && (encoding & las_header::kTimeOffsetBit) != 0) {
    choices.losses.emplace_back("the offset of all times, which LAS 1.5 has");
  }
  encoding &= ~(las_header::kTimeOffsetBit | las_header::kWktBit);
  if (name_system_in_wkt(file)) {
    encoding |= las_header::kWktBit;
  } else {
    choices.losses.emplace_back(
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
  const auto is_copc = [](const LasRecord& record) {
    return record.user_id == kCopcInfoRecord.user_id;
  };
  std::erase_if(file.records, is_copc);  // of another file that became LAS
  std::erase_if(file.extended_records, is_copc);
  file.records.insert(file.records.begin(), new_record(kCopcInfoRecord, "COPC info",
                                                       std::string(copc_info::kBytes, '\0')));
  choices.promoted = before != format;
}

}  // namespace pcednet::io
