#pragma once

#include <optional>
#include <string>
#include <vector>

#include "pcednet/io/las/file.h"

namespace pcednet::io {

/// The comments of a cloud as a record of user id "pcednet", number 1: lines of UTF-8 text. None if
/// there are no comments, or more than the 64 KiB of a record.
std::optional<LasRecord> las_comment_record(const std::vector<std::string>& comments);

/// Removes such records from a file and returns their lines, control characters as blanks.
std::vector<std::string> take_las_comments(LasFile& file);

}  // namespace pcednet::io
