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
/// Throws Error(kUsage) for another extension, for an existing file, and as check_consistent()
/// does; Error(kInsufficient) for a position that LAS cannot hold, as one that is not finite;
/// Error(kFailure) when the disk is full, the folder is missing, or the format cannot hold another
/// value.
void write_cloud(const std::filesystem::path& path, const PointCloud& cloud,
                 const io::WriteOptions& options = {});

/// Throws the errors of write_cloud for positions and the extension: before work on the cloud whose
/// result is to be written.
void check_positions(const std::filesystem::path& path, const PointCloud& cloud);

/// The parts of `cloud` that the format of the extension cannot hold, as phrases; empty if it holds
/// everything. Throws Error(kUsage) like write_cloud.
std::vector<std::string> losses(const std::filesystem::path& path, const PointCloud& cloud);

}  // namespace pcednet::formats
