#pragma once

#include <filesystem>

namespace pcednet::formats {

/// Throws Error(kUsage), naming the file, for a path that JSON cannot hold: one that is not UTF-8.
void check_is_utf8(const std::filesystem::path& path);

/// The file that a JSON file names as `written`, where bytes that are not UTF-8 are replaced: that
/// of this name or else the first, by the bytes, whose name becomes this one. `written` where there
/// is none.
std::filesystem::path find_written(const std::filesystem::path& written);

}  // namespace pcednet::formats
