#include "pcednet/io/coordinate_system.h"

#include <map>

#include "pcednet/io/las/file.h"
#include "pcednet/io/las/las.h"
#include "pcednet/io/length_units.h"

namespace pcednet::io {
namespace {

// GeoTIFF keys, and the values without meaning.
constexpr std::uint16_t kGeographicType = 2048, kProjectedType = 3072, kProjectedUnit = 3076,
                        kVerticalType = 4096, kVerticalUnit = 4099;
constexpr int kUserDefined = 32767;

/// The keys with an inline value, as codes have.
std::map<std::uint16_t, int> geo_keys(std::string_view data) {
  constexpr std::size_t kEntryBytes = 8;
  std::map<std::uint16_t, int> keys;
  for (std::size_t at = kEntryBytes; at + kEntryBytes <= data.size(); at += kEntryBytes) {
    const bool stands_here = number_at<std::uint16_t>(data, at + 2) == 0;
    const int value = number_at<std::uint16_t>(data, at + 6);
    if (stands_here && value != kUserDefined) {
      keys.emplace(number_at<std::uint16_t>(data, at), value);
    }
  }
  return keys;
}

CoordinateSystem coordinate_system_of_keys(std::string_view data) {
  const auto keys = geo_keys(data);
  const auto value = [&](std::uint16_t key, int otherwise) {
    const auto found = keys.find(key);
    return found == keys.end() ? otherwise : found->second;
  };
  CoordinateSystem system;
  system.epsg = value(kProjectedType, value(kGeographicType, 0));
  system.vertical_epsg = value(kVerticalType, 0);
  const int unit = value(kProjectedUnit, 0);
  if (value(kVerticalUnit, unit) == unit) system.unit = unit_of_code(unit);
  return system;
}

}  // namespace

CoordinateSystem coordinate_system_of(const LasFile& file) {
  CoordinateSystem system;
  for (const auto* records : {&file.records, &file.extended_records}) {
    for (const LasRecord& record : *records) {
      if (record.is(kWktRecord)) return coordinate_system_of_wkt(until_zero(record.data));
      if (record.is(kGeoKeysRecord)) system = coordinate_system_of_keys(record.data);
    }
  }
  return system;
}

CoordinateSystem las_coordinate_system(const PointCloud& cloud) {
  return coordinate_system_of(attached_las_file(cloud));
}

}  // namespace pcednet::io
