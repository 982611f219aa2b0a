#pragma once

#include <cstddef>
#include <filesystem>
#include <memory>

#include "pcednet/io/loaded_cloud.h"

namespace pcednet::io {
class PartReader;
}

namespace pcednet::formats {

/// Reads a point file in the format_of() it: PLY, PCD, LAS, LAZ or E57 by its first bytes;
/// otherwise OBJ (.obj) or text (.xyz, .txt, .asc, .pts, .csv) by its extension.
///
/// Normals are made unit, unusable ones (0,0,0), and left out if all are unusable; the warnings
/// count these and positions that are not finite. A file without points gives an empty cloud.
/// Throws Error(kUnreadable) naming the file and the line or byte that cannot be read,
/// Error(kInsufficient) if it does not hold points with x, y and z.
io::LoadedCloud read_cloud(const std::filesystem::path& path);

/// Opens LAS, LAZ and binary PLY for reading in parts of about `most` points (LAZ: in whole
/// chunks), E57 scan by scan. Null for files that can only be read whole: other formats, files
/// without points, PLY with lists in its vertices, much besides them, or colours or labels of types
/// other than uint8. Throws as read_cloud.
std::unique_ptr<io::PartReader> open_parts(const std::filesystem::path& path,
                                           std::size_t most = std::size_t{1} << 19);

}  // namespace pcednet::formats
