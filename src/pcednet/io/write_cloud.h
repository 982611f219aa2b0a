#pragma once

#include <filesystem>
#include <string>
#include <vector>

#include "pcednet/cloud/point_cloud.h"
#include "pcednet/core/output_file.h"

namespace pcednet::io {

struct WriteOptions {
  Overwrite overwrite = Overwrite::kNo;
  bool ascii = false;       ///< numbers as text in formats that have both
  bool new_normals = true;  ///< LAS: normals become extra bytes even where the input had none
};

/// Writes `cloud` in the format that the extension names: .ply, .pcd, .las, .laz, .obj, or text
/// (.xyz, .txt, .asc, .pts, .csv). The file appears under its name only when it is complete.
///
/// Throws Error(kUsage) for another extension or an existing file, Error(kFailure) when the disk
/// takes no more or the cloud's vectors differ in length.
void write_cloud(const std::filesystem::path& path, const PointCloud& cloud,
                 const WriteOptions& options = {});

/// What the format that the extension names cannot hold of `cloud`, one sentence part each; empty
/// if it holds everything. Throws Error(kUsage) like write_cloud.
std::vector<std::string> losses(const std::filesystem::path& path, const PointCloud& cloud);

}  // namespace pcednet::io
