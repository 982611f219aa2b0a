#pragma once

#include <filesystem>
#include <string>
#include <vector>

#include "pcednet/cloud/point_cloud.h"
#include "pcednet/io/input_file.h"
#include "pcednet/io/loaded_cloud.h"
#include "pcednet/io/write_options.h"

namespace pcednet::io {

/// Reads the vertices of a Wavefront OBJ: `v x y z`, with a weight, which is ignored, or colours.
///
/// Faces become the element `face`, the segments of lines the element `edge`; points are left out,
/// with a warning. A vertex gets the mean of the unit normals that faces, lines and points give its
/// corners (v//vn, v/vt/vn); in a file without such corners, `vn` number i belongs to `v` number i
/// if their numbers are equal. A corner whose normal does not exist is read without it, with a
/// warning. Throws Error(kUnreadable) naming the line of a broken number or an index of a vertex
/// out of range.
LoadedCloud read_obj(const InputFile& file);

/// Writes `v` lines, with colours in 0 ... 1 if there are any, and as many `vn` lines if the cloud
/// has normals.
void write_obj(const std::filesystem::path& path, const PointCloud& cloud,
               const WriteOptions& options = {});

/// The parts of `cloud` that write_obj() does not keep, as phrases.
std::vector<std::string> obj_losses(const PointCloud& cloud);

}  // namespace pcednet::io
