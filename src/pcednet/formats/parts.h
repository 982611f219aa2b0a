#pragma once

#include <cstddef>
#include <filesystem>
#include <memory>

#include "pcednet/io/parts.h"

namespace pcednet::formats {

/// Opens LAS, LAZ, binary PLY and text (which is read for that) for reading in parts of about
/// `most` points (LAZ: in whole chunks), E57 scan by scan. Null for files that can only be read
/// whole: other formats, files without points, text as open_xyz_parts() says, PLY with lists in its
/// vertices, much besides them, or colours or labels of types other than uint8, unless these are
/// beside colours of uint8. Throws as read_cloud.
std::unique_ptr<io::PartReader> open_parts(const std::filesystem::path& path,
                                           std::size_t most = std::size_t{1} << 19);

/// Opens a file to append the parts that `outline` describes: the same bytes as write_cloud() of
/// all parts as one cloud. Null for formats that can only be written whole: .pcd and .obj. Throws
/// as write_cloud.
std::unique_ptr<io::PartWriter> create_parts(const std::filesystem::path& path,
                                             const io::PartOutline& outline,
                                             const io::WriteOptions& options);

}  // namespace pcednet::formats
