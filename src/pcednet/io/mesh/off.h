#pragma once

#include "pcednet/io/input_file.h"
#include "pcednet/io/loaded_cloud.h"

namespace pcednet::io {

/// Reads the vertices of an Object File Format text (OFF, with any of Geomview's ST, C and N before
/// it), a vertex or face a line: positions, normals, colours (an alpha becomes the attribute
/// `alpha`), and the faces as the element `face`.
///
/// The first line may lack the keyword, or hold the counts behind it without a blank, as in
/// ModelNet. Texture coordinates, colours of faces and numbers that the keyword does not announce
/// are left out, with a warning. Throws Error(kUnreadable) naming the line of a broken number, of a
/// vertex number out of range, or where the file ends too early; also for binary files and other
/// than three dimensions.
LoadedCloud read_off(const InputFile& file);

}  // namespace pcednet::io
