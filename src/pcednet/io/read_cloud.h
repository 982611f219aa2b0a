#pragma once

#include <filesystem>

#include "pcednet/io/loaded_cloud.h"

namespace pcednet::io {

/// Reads a point file: PLY, PCD, LAS, LAZ or E57 by how it begins; otherwise OBJ (.obj) or text
/// (.xyz, .txt, .asc, .pts, .csv) by its extension.
///
/// Normals are made unit, unusable ones (0,0,0), and left out if all are unusable; the warnings
/// count these and positions that are not finite. A file without points gives an empty cloud.
/// Throws Error(kUnreadable) naming the file and the line or byte that cannot be read,
/// Error(kInsufficient) if what it holds are not points with x, y and z.
LoadedCloud read_cloud(const std::filesystem::path& path);

/// The format that read_cloud would choose: "PLY", "PCD", "LAS", "E57", "OBJ" or "text".
/// Throws Error(kUnreadable) if there is none.
const char* format_name(const std::filesystem::path& path);

}  // namespace pcednet::io
