#pragma once

#include <cstddef>
#include <string>
#include <string_view>

#include "pcednet/cloud/point_cloud.h"

namespace pcednet::io {

/// The name of the column for the attribute `name`: with its characters that end a word in some
/// format (blanks, commas, semicolons, quotes, control characters) percent-encoded.
std::string column_name(std::string_view name);

/// Another column name for the same attribute, where `column` stands for something else already:
/// with one more character encoded.
std::string hidden(std::string column);

/// The name that either of them was made from.
std::string attribute_name(std::string_view column);

/// What the columns for the halves of a 64-bit integer add to its name, in formats that have none;
/// column_name() hides these endings in other names.
inline constexpr std::string_view kLowHalf = "_low32", kHighHalf = "_high32";

/// Gives attributes the names that their columns stand for, and joins halves that follow one
/// another to 64-bit integers.
void restore_attributes(PointCloud& cloud);

}  // namespace pcednet::io
