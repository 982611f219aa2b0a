#pragma once

#include <filesystem>
#include <optional>
#include <span>
#include <utility>

namespace pcednet::app {

/// Two files of the LAS, LAZ and COPC files among these that lie side by side, seen from above, as
/// the tiles of a survey do: their boxes touch or overlap at the edge. None if there are none.
/// Reads headers only, and passes over files that it cannot read.
std::optional<std::pair<std::filesystem::path, std::filesystem::path>> find_adjoining(
    std::span<const std::filesystem::path> files);

}  // namespace pcednet::app
