#pragma once

#include <string>
#include <string_view>

#include "pcednet/cloud/point_cloud.h"

namespace pcednet::io {

/// The name of the column for the attribute `name`: characters that end a word in some format
/// (blanks, commas, semicolons, quotes, control characters) are percent-encoded.
std::string column_name(std::string_view name);

/// `text` with the character that each "%XX" stands for: the name that column_name(), and hidden()
/// after it, encoded.
std::string percent_decoded(std::string_view text);

/// Another column name for the same attribute, with one more character encoded, for use where
/// `column` already has another meaning.
std::string hidden(std::string column);

/// Suffixes of the columns for the halves of a 64-bit integer, in formats without such integers;
/// column_name() hides these suffixes in other names.
inline constexpr std::string_view kLowHalf = "_low32", kHighHalf = "_high32";

/// Gives attributes the names that their columns encode, and joins consecutive halves to 64-bit
/// integers.
void restore_attributes(PointCloud& cloud);

}  // namespace pcednet::io
