#pragma once

#include <span>
#include <string_view>

#include "pcednet/io/coordinate_system.h"

namespace pcednet::io {

/// A unit of length and its codes.
struct LengthUnitEntry {
  LengthUnit unit;
  int epsg;               ///< its code; 0: none
  std::string_view name;  ///< in options: "m"
  double metres;          ///< 0: unknown
  int dxf_code;           ///< `$INSUNITS`
  bool imperial;          ///< DXF: `$MEASUREMENT` is 0
};

/// The whole table.
std::span<const LengthUnitEntry> length_units();

const LengthUnitEntry& entry_of(LengthUnit unit);

/// The unit of that length, as a definition rounds it; kNone if the table has none.
LengthUnit unit_of_metres(double metres);

/// The unit with that EPSG code; kNone if the table has none.
LengthUnit unit_of_code(int epsg);

}  // namespace pcednet::io
