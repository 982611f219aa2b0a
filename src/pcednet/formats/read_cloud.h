#pragma once

#include <filesystem>

#include "pcednet/io/loaded_cloud.h"

namespace pcednet::formats {

/// Reads a point file: PLY, PCD, LAS, LAZ or E57 by its first bytes; otherwise PTX (.ptx), OBJ
/// (.obj), OFF (.off), STL (.stl) or text (.xyz, .txt, .asc, .pts, .csv) by its extension.
///
/// Normals are made unit, unusable ones (0,0,0), and left out if all are unusable; the warnings
/// count these and positions that are not finite. A file without points gives an empty cloud.
/// Throws Error(kUnreadable) naming the file and the line or byte that cannot be read,
/// Error(kInsufficient) if it does not hold points with x, y and z.
io::LoadedCloud read_cloud(const std::filesystem::path& path);

}  // namespace pcednet::formats
