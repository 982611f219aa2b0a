#pragma once

#include <filesystem>

namespace pcednet::formats {

/// Throws Error(kUsage), naming the file, for a path that JSON cannot hold: one that is not UTF-8.
void check_is_utf8(const std::filesystem::path& path);

}  // namespace pcednet::formats
