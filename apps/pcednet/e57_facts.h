#pragma once

#include <filesystem>
#include <nlohmann/json.hpp>

namespace pcednet::app {

/// What `info` says of an E57 file beyond its points: per scan the name, sensor, number of points,
/// pose, scanner's place, and fields with their kinds and ranges. Throws as read_cloud().
nlohmann::ordered_json e57_facts(const std::filesystem::path& path);

/// Prints them, a line per scan and per field, in the manner of `info`.
void print_e57_facts(const nlohmann::ordered_json& facts);

}  // namespace pcednet::app
