#pragma once

#include <filesystem>
#include <memory>
#include <string>
#include <vector>

#include "pcednet/cloud/point_cloud.h"
#include "pcednet/io/input_file.h"
#include "pcednet/io/loaded_cloud.h"
#include "pcednet/io/parts.h"
#include "pcednet/io/write_options.h"

namespace pcednet::io {

/// Reads points from a text, one a line, with numbers separated by blanks, tabs, semicolons or
/// commas; or with decimal commas, if a line proves it: see commas_of().
///
/// Lines that begin with # or // are comments; a line of names, commented or not, with x, y and z
/// among them names the columns, which CloudBuilder then reads as of type double: of such comments
/// the last with as many names as there are columns. Without names, columns after the third are
/// taken for normals, colours or labels by their values, with a warning. A first line with one
/// whole number is the count of points; as many points later another count may follow, that of the
/// next scan. Throws Error(kUnreadable) naming the line that does not fit the others.
LoadedCloud read_xyz(const InputFile& file);

/// The same in parts of `most` points. It reads the whole file once, to find the parts and the
/// columns. Null for UTF-16, and where a part alone does not show the colours and labels: those
/// that are not whole numbers in 0 ... 255.
std::unique_ptr<PartReader> open_xyz_parts(std::unique_ptr<InputFile> file, std::size_t most);

/// Whether a text begins as read_xyz() reads one: after comments, a count of points or names of
/// columns with x, y and z, with at least three numbers in a line. True as well where that cannot
/// be told from its first 64 KiB.
bool begins_as_points(const InputFile& file);

/// Writes points as text: comments and names behind #, then one point a line; .csv with commas and
/// the names alone; .pts with a count first, then comments and names, and with its columns in the
/// order x y z intensity red green blue. Positions alone, positions with normals in .xyz, and those
/// columns in .pts are written without comments and names, as programs that know neither expect.
std::unique_ptr<PartWriter> create_xyz_parts(const std::filesystem::path& path,
                                             const PartOutline& outline,
                                             const WriteOptions& options);

/// The parts of a cloud that text does not keep, as phrases.
std::vector<std::string> xyz_losses(const std::filesystem::path& path, const PartOutline& outline);

}  // namespace pcednet::io
