#pragma once

#include <filesystem>
#include <nlohmann/json.hpp>

#include "pcednet/cloud/point_cloud.h"

namespace pcednet::app {

/// What `info` says of a LAS or LAZ file beyond its points: version, point format, what wrote it
/// and when, scale and offset, coordinate system, records, and points by return and by class.
/// Throws as read_cloud().
nlohmann::ordered_json las_facts(const std::filesystem::path& path, const PointCloud& cloud);

/// Prints them, a line each, in the manner of `info`.
void print_las_facts(const nlohmann::ordered_json& facts);

}  // namespace pcednet::app
