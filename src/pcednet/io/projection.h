#pragma once

#include <array>
#include <optional>
#include <string>
#include <vector>

#include "pcednet/io/coordinate_system.h"

namespace pcednet::io {

/// Whether this build has PROJ; without it the functions below know no system.
bool has_projections();

/// Whether the system is of heights alone, by its WKT, otherwise by its codes: x and y have none.
bool is_of_heights_alone(const CoordinateSystem& system);

enum class WktVersion { k1, k2 };  ///< OGC 01-009, as in LAS; ISO 19162:2019

/// The definition of a system on one line: from its WKT, otherwise from its codes. Empty if PROJ
/// does not know it.
std::string definition_of(const CoordinateSystem& system, WktVersion version);

/// The EPSG code of the system that a definition without codes, as ESRI writes them, describes; 0
/// unless PROJ knows one that is surely the same.
int code_of_definition(const std::string& wkt);

/// The system of a code that a user gives, with that of its heights unless it is 0, and with its
/// definition and unit as far as this build has PROJ. Throws Error(kUsage), which begins with the
/// codes, for numbers that are no codes of a system of x and y and one of heights: out of
/// kLeastEpsgCode to kMostEpsgCode or, with PROJ, unknown to it or, as `epsg`, of heights alone.
CoordinateSystem system_of_code(int epsg, int heights = 0);

/// Points (x, y) of a system as (longitude, latitude) of WGS 84, in degrees. None if PROJ does not
/// know the system, or one of them has no place there.
std::optional<std::vector<std::array<double, 2>>> to_wgs84(
    const CoordinateSystem& system, std::vector<std::array<double, 2>> points);

}  // namespace pcednet::io
