#pragma once

#include <filesystem>
#include <vector>

#include "pcednet/io/input_file.h"
#include "pcednet/lines/curves/curve.h"

namespace pcednet::io {

/// Reads the lines of an OBJ or a PLY file, each as a polyline.
///
/// OBJ: every `l` is a curve, of the class that the `o` or `g` before it names (sharp-edge,
/// smooth-edge, boundary), otherwise sharp. PLY: the element `edge` with vertex1 and vertex2; a row
/// continues a curve if it begins where the row before ended and has the same number in the
/// property `curve`, if there is one; the property `class` holds an EdgeClass. A curve that ends at
/// its first vertex is closed. Vertices that repeat the one before are dropped.
///
/// Throws Error(kUnreadable), naming the file and the line, row or byte, for a syntax error, a
/// vertex that is missing or not finite, and a line whose vertices all coincide;
/// Error(kInsufficient) for a file with vertices but no lines.
std::vector<lines::Curve> read_curves(const std::filesystem::path& path);

// The same by format.
std::vector<lines::Curve> read_obj_curves(const InputFile& file);
std::vector<lines::Curve> read_ply_curves(const InputFile& file);

}  // namespace pcednet::io
