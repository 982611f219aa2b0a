#pragma once

#include <filesystem>

namespace pcednet::app {

/// Whether a text begins as formats::read_cloud() reads one: after comments, a count of points or
/// names of columns with x, y and z, with at least three numbers in a line. True as well where that
/// cannot be told from its first 64 KiB.
bool begins_like_points(const std::filesystem::path& text);

}  // namespace pcednet::app
