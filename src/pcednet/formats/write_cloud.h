#pragma once

#include <filesystem>
#include <memory>
#include <string>
#include <vector>

#include "pcednet/cloud/point_cloud.h"
#include "pcednet/io/write_options.h"

namespace pcednet::io {
class PartWriter;
struct PartOutline;
}  // namespace pcednet::io

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

/// Opens a file to append the parts that `outline` describes: the same bytes as write_cloud() of
/// all parts as one cloud. Null for formats that can only be written whole: .pcd and .obj. Throws
/// as write_cloud.
std::unique_ptr<io::PartWriter> create_parts(const std::filesystem::path& path,
                                             const io::PartOutline& outline,
                                             const io::WriteOptions& options);

}  // namespace pcednet::formats
