#include <algorithm>

#include "pcednet/io/las/copc.h"
#include "pcednet/io/text_scan.h"

namespace pcednet::io {
namespace {

bool has_field(unsigned format, const char* name) {
  const std::vector<LasField> fields = las_standard_fields(format);
  return std::any_of(fields.begin(), fields.end(),
                     [&](const LasField& f) { return f.name == name; });
}

/// Of those of COPC, the one that has the colours of `format`, or of the cloud.
unsigned copc_format(unsigned format, const PointCloud& first) {
  const Attribute* infrared = find_attribute(first, "Infrared");
  if (has_field(format, "Infrared")) return 8;
  if (!has_field(format, "Red") && first.colours.empty()) return 6;
  return infrared && infrared->type == ScalarType::kUint16 ? 8 : 7;
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
  auto encoding = number_at<std::uint16_t>(file.header, las_header::kGlobalEncoding);
  if (file.minor_version() < 2) encoding = 0;  // had no meaning yet
  choices.lost_time_offset = file.has_time_range() && (encoding & las_header::kTimeOffsetBit) != 0;
  encoding &= static_cast<std::uint16_t>(~las_header::kTimeOffsetBit);
  encoding |= las_header::kWktBit;
  file.header.resize(las_header::kBytes14);
  put_number(file.header, las_header::kGlobalEncoding, encoding);
  put_number<std::uint8_t>(file.header, las_header::kMinorVersion, 4);
  put_number(file.header, las_header::kPointFormat, static_cast<std::uint8_t>(format));
  put_number(file.header, las_header::kRecordLength,
             static_cast<std::uint16_t>(las_format_bytes(format) + extra));
  file.records.insert(file.records.begin(), new_record(kCopcInfoRecord, "COPC info",
                                                       std::string(copc_info::kBytes, '\0')));
  choices.promoted = before != format;
}

}  // namespace pcednet::io
