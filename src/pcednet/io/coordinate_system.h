#pragma once

#include <string>
#include <string_view>
#include <vector>

namespace pcednet::io {

enum class LengthUnit { kNone, kMillimetre, kCentimetre, kMetre, kInch, kFoot, kUsSurveyFoot };

/// The coordinate system of a file, as far as it is known.
struct CoordinateSystem {
  int epsg = 0;                         ///< its code; 0: unknown
  std::string wkt = {};                 ///< its definition (OGC 01-009 or 18-010); may be empty
  LengthUnit unit = LengthUnit::kNone;  ///< of all its lengths; kNone: another, or they differ
  int vertical_epsg = 0;    ///< code of the heights if `epsg` does not cover them; 0: unknown
  bool geographic = false;  ///< x and y are angles: longitude and latitude
  bool stretched = false;   ///< heights have another unit than x and y, beyond a thousandth
};

/// EPSG has no codes of coordinate systems below and beyond these; 32767 says that there is none.
inline constexpr int kLeastEpsgCode = 1024, kMostEpsgCode = 32766;

/// The code that a word of digits stands for; 0 if it stands for none.
int epsg_code(std::string_view word);

/// The codes as people write them, with that of the heights: "EPSG:25832+7837"; empty if `epsg` is
/// unknown.
std::string code_text(const CoordinateSystem& system);

/// The system that a definition describes: its code is that of the outermost EPSG AUTHORITY or ID;
/// of a compound system without one, the codes are those of its parts. That of heights alone has no
/// unit and no code but that of the heights.
CoordinateSystem coordinate_system_of_wkt(std::string_view wkt);

/// Whether units of `a` and `b` metres differ by more than a thousandth; 0 is an unknown one.
bool is_stretched(double a, double b);

/// The part of a definition that describes the heights, without blanks and in capitals; empty if
/// there is none.
std::string heights_in(std::string_view wkt);

/// Begins the comment that carries the definition of a cloud which is not of LAS, such as of E57.
inline constexpr std::string_view kSystemComment = "coordinate system: ";

/// The definition in such a comment; empty if there is none, or another text than a definition.
std::string wkt_of_comments(const std::vector<std::string>& comments);

}  // namespace pcednet::io
