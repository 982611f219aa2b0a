#pragma once

#include <filesystem>
#include <memory>
#include <string_view>

#include "pcednet/cloud/point_cloud.h"
#include "pcednet/io/input_file.h"
#include "pcednet/io/loaded_cloud.h"
#include "pcednet/io/parts.h"
#include "pcednet/io/write_options.h"

namespace pcednet::io {

/// Whether a file with this beginning is PLY.
bool begins_as_ply(std::string_view start);

/// Reads PLY 1.0: ascii, binary of either byte order, properties in any order and of any type.
///
/// Scalar properties of the element `vertex` go to a CloudBuilder; its lists are skipped, with a
/// warning; other elements become foreign elements. Throws Error(kUnreadable) where the file breaks
/// the format or ends too early, Error(kInsufficient) if it has no vertices with x, y and z.
LoadedCloud read_ply(const InputFile& file);

/// For open_parts(): null unless the file is binary and holds little besides points.
std::unique_ptr<PartReader> open_ply_parts(std::unique_ptr<InputFile> file, std::size_t most);

/// Writes PLY 1.0, binary little-endian unless options.ascii, in an order that common programs
/// expect: x y z; nx ny nz; uchar red green blue; attribute `quality`; attributes `scalar_*`; other
/// attributes; uchar label. Then the foreign elements of the first part, which must outlive the
/// writer.
std::unique_ptr<PartWriter> create_ply_parts(const std::filesystem::path& path,
                                             const PartOutline& outline,
                                             const WriteOptions& options);

}  // namespace pcednet::io
