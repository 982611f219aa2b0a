#include "pcednet/io/coordinate_system.h"

#include <fmt/format.h>

#include <algorithm>
#include <map>
#include <utility>

#include "pcednet/io/las/file.h"
#include "pcednet/io/las/las.h"
#include "pcednet/io/length_units.h"
#include "pcednet/io/projection.h"

namespace pcednet::io {
namespace {

// GeoTIFF keys, and the values without meaning.
constexpr std::uint16_t kModelType = 1024, kGeographicType = 2048, kProjectedType = 3072,
                        kProjectedUnit = 3076, kVerticalType = 4096, kVerticalUnit = 4099;
constexpr int kUserDefined = 32767;
constexpr int kProjectedModel = 1, kGeographicModel = 2;

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

/// The unit that PROJ knows of the system's codes; `heights` is the code of theirs, if the file
/// states it.
LengthUnit unit_of_system(CoordinateSystem system, int heights) {
  if (heights > 0) system.vertical_epsg = 0;
  const LengthUnit unit = coordinate_system_of_wkt(definition_of(system, WktVersion::k1)).unit;
  return heights == 0 || unit_of_code(heights) == unit ? unit : LengthUnit::kNone;
}

/// Where the keys give codes alone, PROJ tells the unit if it is to be asked, which takes time.
CoordinateSystem coordinate_system_of_keys(std::string_view data, bool ask_for_unit) {
  const auto keys = geo_keys(data);
  const auto value = [&](std::uint16_t key, int otherwise) {
    const auto found = keys.find(key);
    return found == keys.end() ? otherwise : found->second;
  };
  const int model = value(kModelType, value(kProjectedType, 0) == 0 && value(kGeographicType, 0) > 0
                                          ? kGeographicModel
                                          : kProjectedModel);
  CoordinateSystem system;
  // A projection of one's own has no code, though the angles that it projects have one.
  system.epsg = value(kProjectedType, model == kProjectedModel ? 0 : value(kGeographicType, 0));
  system.vertical_epsg = value(kVerticalType, 0);
  system.geographic = model == kGeographicModel;
  if (system.geographic) return system;
  const int unit = value(kProjectedUnit, 0), heights = value(kVerticalUnit, unit);
  if (unit > 0 && heights == unit) system.unit = unit_of_code(unit);
  system.stretched =
      is_stretched(entry_of(unit_of_code(unit)).metres, entry_of(unit_of_code(heights)).metres);
  if (unit == 0 && ask_for_unit) system.unit = unit_of_system(system, heights);
  return system;
}

/// A definition may name no code: PROJ tells it, as above.
CoordinateSystem coordinate_system_of_text(const std::string& wkt, bool ask_for_code) {
  CoordinateSystem system = coordinate_system_of_wkt(wkt);
  if (!ask_for_code || system.epsg > 0 || is_of_heights_alone(system)) return system;
  // ESRI puts the system of heights behind the other.
  system.epsg = code_of_definition(wkt.substr(0, wkt.find(",VERTCS[")));
  return system;
}

/// `ask`: PROJ, for what the file leaves open.
CoordinateSystem find_system(const LasFile& file, bool ask) {
  CoordinateSystem system;
  for (const LasRecord* record : all_records(file)) {
    if (record->is(kWktRecord)) return coordinate_system_of_text(until_zero(record->data), ask);
    if (record->is(kGeoKeysRecord)) system = coordinate_system_of_keys(record->data, ask);
  }
  return system;
}

/// Whether they have any, with a code or without.
bool has_geo_keys(const LasFile& file) {
  return std::ranges::any_of(all_records(file), [](const LasRecord* record) {
    return record->is(kGeoKeysRecord) && !geo_keys(record->data).empty();
  });
}

}  // namespace

CoordinateSystem coordinate_system_of(const LasFile& file) {
  return find_system(file, false);
}

CoordinateSystem las_coordinate_system(const PointCloud& cloud) {
  const auto& elements = cloud.foreign_elements;
  if (std::any_of(elements.begin(), elements.end(), is_las_element)) {
    return find_system(attached_las_file(cloud), true);
  }
  return coordinate_system_of_text(wkt_of_comments(cloud.comments), true);
}

bool names_system(const LasFile& file) {
  const CoordinateSystem system = coordinate_system_of(file);
  return system.epsg > 0 || !system.wkt.empty() || has_geo_keys(file);
}

bool names_heights(const LasFile& file) {
  const CoordinateSystem system = coordinate_system_of(file);
  return system.vertical_epsg > 0 || !heights_in(system.wkt).empty();
}

std::vector<std::string> las_element_losses(const PointCloud& cloud) {
  const auto& elements = cloud.foreign_elements;
  if (std::none_of(elements.begin(), elements.end(), is_las_element)) return {};
  std::vector<std::string> losses;
  const LasFile file = attached_las_file(cloud);
  const CoordinateSystem system = coordinate_system_of(file);
  if (names_system(file)) {
    const std::string code = code_text(system);
    losses.push_back(code.empty() ? "coordinate system" : "coordinate system " + code);
  }
  losses.emplace_back("header and records of LAS");
  return losses;
}

}  // namespace pcednet::io
