#pragma once

#include <filesystem>
#include <string_view>

#include "pcednet/cloud/point_cloud.h"
#include "pcednet/io/input_file.h"
#include "pcednet/io/loaded_cloud.h"
#include "pcednet/io/write_options.h"

namespace pcednet::io {

/// Whether a file with this beginning is PCD: comments of any program may come first.
bool begins_as_pcd(std::string_view start);

/// Reads PCD 0.5 to 0.7: ascii, binary and binary_compressed.
///
/// Fields go to a CloudBuilder. The points of an organized cloud are all kept, NaN ones too; its
/// WIDTH and HEIGHT, and a VIEWPOINT other than the origin, become comments that write_pcd turns
/// back. Throws Error(kUnreadable) where the file breaks the format or ends too early,
/// Error(kInsufficient) if it has no x, y and z.
LoadedCloud read_pcd(const InputFile& file);

/// Writes PCD 0.7, binary unless options.ascii: x y z, normal_x ..., rgb, attributes, label.
void write_pcd(const std::filesystem::path& path, const PointCloud& cloud,
               const WriteOptions& options = {});

}  // namespace pcednet::io
