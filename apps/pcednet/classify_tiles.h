#pragma once

#include <functional>
#include <string>
#include <vector>

#include "pcednet/io/write_options.h"
#include "tiled_cloud.h"

namespace pcednet::app {

struct TiledResult {
  io::WriteOptions write;
  /// Adds the findings to the next part of the cloud.
  std::function<void(PointCloud& part, const tiles::TileFindings& findings)> add_result;
  /// Called with each part as written, and the number of points before it.
  std::function<void(const PointCloud& part, std::size_t before)> see;
};

/// Writes a cloud with the findings of its tiles, its points in their order: the same file as for
/// the cloud in memory, except for labels that differ (docs/large.md). Returns what its format
/// cannot hold.
std::vector<std::string> write_tiled(const std::filesystem::path& output, const TiledCloud& cloud,
                                     const TiledResult& result, const Progress& progress);

}  // namespace pcednet::app
