#pragma once

#include "pcednet/io/input_file.h"
#include "pcednet/io/loaded_cloud.h"

namespace pcednet::io {

/// Reads the triangles of an STL, binary or ASCII: their corners as points, equal ones once, in the
/// order in which they occur first, and the triangles as the element `face`.
///
/// A file is binary if its size follows from the count in bytes 80 to 83, even if it begins with
/// solid. Normals are left out, as the corners give them; so are the names of solids. Throws
/// Error(kUnreadable) naming the line or byte where the file breaks the format or ends too early.
LoadedCloud read_stl(const InputFile& file);

}  // namespace pcednet::io
