#include "pcednet/tiles/las_meaning.h"

#include <fmt/format.h>

#include <algorithm>
#include <string_view>

#include "pcednet/io/las/las.h"

namespace pcednet::tiles {
namespace {

ExtraMeaning meaning_of(const io::LasField& field, std::string_view descriptor) {
  using namespace io::las_descriptor;
  constexpr std::size_t kNumber = 8;
  ExtraMeaning meaning{.type = io::number_at<std::uint8_t>(descriptor, kType),
                       .components = field.components};
  if (meaning.type == 0) return meaning;  // bytes, and the options are how many
  const auto options = io::number_at<std::uint8_t>(descriptor, kOptions);
  if (options & kNoDataBit)
    meaning.no_data = descriptor.substr(kNoData, kNumber * field.components);
  for (std::size_t at = 0; at < kNumber * field.components; at += kNumber) {
    meaning.scale.push_back(options & kScaleBit ? io::number_at<double>(descriptor, kScale + at)
                                                : 1.0);
    meaning.offset.push_back(options & kOffsetBit ? io::number_at<double>(descriptor, kOffset + at)
                                                  : 0.0);
  }
  return meaning;
}

/// The records on the coordinate system, verbatim.
std::map<std::uint16_t, std::string> system_records(const io::LasFile& file) {
  std::map<std::uint16_t, std::string> found;
  for (const io::LasRecord* record : io::all_records(file)) {
    if (record->user_id == io::kWktRecord.user_id) found[record->record_id] = record->data;
  }
  return found;
}

/// Whether two systems are the same by their codes, written as they may be.
bool are_same(const io::CoordinateSystem& a, const io::CoordinateSystem& b) {
  if (a.epsg == 0 || a.epsg != b.epsg || a.vertical_epsg != b.vertical_epsg) return false;
  return a.vertical_epsg > 0 || io::heights_in(a.wkt) == io::heights_in(b.wkt);
}

std::string name_of(const io::CoordinateSystem& system) {
  if (system.epsg == 0) return system.wkt.empty() ? "none that is known" : "one without a code";
  if (system.vertical_epsg > 0) return fmt::format("{}+{}", system.epsg, system.vertical_epsg);
  return fmt::format("{}{}", system.epsg,
                     io::heights_in(system.wkt).empty() ? "" : " and heights without a code");
}

}  // namespace

std::map<std::string, ExtraMeaning> extra_meanings(const io::LasFile& file) {
  std::vector<std::string> known;
  std::map<std::string, ExtraMeaning> meanings;
  const io::LasRecord* const record = io::find_record(file.records, io::kExtraBytesRecord);
  for (const io::LasField& field : io::las_extra_fields(file, known)) {
    if (!field.descriptor) continue;
    const std::string_view data = record->data;
    meanings[field.name] =
        meaning_of(field, data.substr(*field.descriptor, io::las_descriptor::kBytes));
  }
  return meanings;
}

int system_rank(const io::LasFile& file) {
  return io::names_heights(file) ? 2 : io::names_system(file) ? 1 : 0;
}

std::string different_systems(const PointCloud& a, const PointCloud& b) {
  const io::LasFile first = io::attached_las_file(a), other = io::attached_las_file(b);
  if (system_records(first) == system_records(other)) return "";
  const int rank = system_rank(first), others_rank = system_rank(other);
  if (rank == 0 || others_rank == 0) return "";
  const auto its = io::las_coordinate_system(a), others = io::las_coordinate_system(b);
  const bool one_has_heights = rank != others_rank && its.epsg > 0 && its.epsg == others.epsg;
  if (one_has_heights || are_same(its, others)) return "";
  return fmt::format("EPSG {}, and {}", name_of(its), name_of(others));
}

TimeBase time_base(const io::LasFile& file) {
  using namespace io::las_header;
  const auto encoding = io::number_at<std::uint16_t>(file.header, kGlobalEncoding);
  TimeBase base{.is_adjusted = (encoding & kStandardTimeBit) != 0,
                .has_offset = file.has_time_range() && (encoding & kTimeOffsetBit) != 0};
  if (base.has_offset) base.offset = io::number_at<std::uint16_t>(file.header, kTimeOffset);
  return base;
}

bool has_waveforms(const io::LasFile& file) {
  // The records 100 to 354 describe them, the last holds them.
  return std::ranges::any_of(io::all_records(file), [](const io::LasRecord* record) {
    return record->user_id == io::kWaveformsRecord.user_id &&
           (record->record_id == io::kWaveformsRecord.record_id ||
            (record->record_id >= 100 && record->record_id <= 354));
  });
}

}  // namespace pcednet::tiles
