#pragma once

#include <filesystem>
#include <string>
#include <vector>

#include "pcednet/cloud/point_cloud.h"
#include "pcednet/io/write_options.h"

namespace pcednet::formats {

/// Writes `cloud` in the format of the extension: .ply, .pcd, .las, .laz, .copc.laz (in its own
/// order), .obj, or text (.xyz, .txt, .asc, .pts, .csv). The file appears under its name only when
/// it is complete.
///
/// Throws Error(kUsage) for another extension or an existing file, Error(kFailure) when the disk is
/// full or the cloud's vectors differ in length.
void write_cloud(const std::filesystem::path& path, const PointCloud& cloud,
                 const io::WriteOptions& options = {});

/// The parts of `cloud` that the format of the extension cannot hold, as phrases; empty if it holds
/// everything. Throws Error(kUsage) like write_cloud.
std::vector<std::string> losses(const std::filesystem::path& path, const PointCloud& cloud);

}  // namespace pcednet::formats
