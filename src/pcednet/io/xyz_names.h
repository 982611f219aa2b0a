#pragma once

#include <string>
#include <string_view>
#include <vector>

namespace pcednet::io {

/// The names in a line of names; those of a .csv may hold blanks.
std::vector<std::string> split_names(std::string_view line);

/// Whether there are columns for positions, in any case: x, y and z, or the names that surveyors
/// use in place of these, which then become x, y and z.
///
/// Those are easting or rechtswert; northing or hochwert; and z, elevation, altitude, height, höhe
/// or hoehe, in this order where there are several. E, n and h count if none of the others is
/// there. Beside an x or a y they are columns like any other. A unit of length in brackets may
/// follow: x [m].
bool name_positions(std::vector<std::string>& names);

}  // namespace pcednet::io
