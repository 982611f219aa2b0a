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

/// Writes `cloud` as the extension says: .ply, .pcd, .las, .laz, .copc.laz (in its own order),
/// .obj, or text (.xyz, .txt, .asc, .pts, .csv). The file gets its name only when it is complete.
///
/// Throws Error(kUsage) for another extension or an existing file, Error(kFailure) when the disk
/// takes no more or the cloud's vectors differ in length.
void write_cloud(const std::filesystem::path& path, const PointCloud& cloud,
                 const io::WriteOptions& options = {});

/// What the format that the extension names cannot hold of `cloud`, one sentence part each; empty
/// if it holds everything. Throws Error(kUsage) like write_cloud.
std::vector<std::string> losses(const std::filesystem::path& path, const PointCloud& cloud);

/// Opens a file to append the parts that `outline` tells of: the same bytes as write_cloud of them
/// all. Null for formats written only as a whole: .pcd and .obj. Throws as write_cloud.
std::unique_ptr<io::PartWriter> create_parts(const std::filesystem::path& path,
                                             const io::PartOutline& outline,
                                             const io::WriteOptions& options);

}  // namespace pcednet::formats
