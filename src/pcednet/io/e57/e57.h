#pragma once

#include <memory>
#include <string_view>

#include "pcednet/io/input_file.h"
#include "pcednet/io/loaded_cloud.h"
#include "pcednet/io/parts.h"

namespace pcednet::io {

/// Whether a file with this beginning is E57.
bool begins_as_e57(std::string_view start);

/// Reads all scans of an E57 file (ASTM E2807) into one cloud, each moved by its pose.
///
/// Points that the file calls invalid are left out, with a warning. Colours are scaled to 8 bits by
/// the file's colour limits. Several scans give the attribute `scan`, their index from 0. Other
/// fields become attributes of their own name and type; fields that a scan lacks are NaN in it.
/// `scanners` is set where the file gives them (see E57Scan::knows_scanner). Throws as
/// read_cloud().
LoadedCloud read_e57(const InputFile& file);

/// For open_parts(): a part is a scan.
std::unique_ptr<PartReader> open_e57_parts(std::unique_ptr<InputFile> file);

}  // namespace pcednet::io
