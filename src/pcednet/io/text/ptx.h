#pragma once

#include "pcednet/io/input_file.h"
#include "pcednet/io/loaded_cloud.h"

namespace pcednet::io {

/// Reads all scans of a PTX file, Leica's text of scans, into one cloud, each moved by its matrix.
///
/// A scan has a header of ten lines (columns, rows, place and axes of the scanner, a matrix that
/// multiplies rows of coordinates from the right) and a line for each cell of its grid: x y z, then
/// the intensity, a colour, or both. Cells at 0 0 0 hold no point and are left out, with a warning.
/// Several scans give the attribute `scan`, their index from 0. `scanners` is the origin of each
/// scan, or its scanner's place if the matrix does not move it; NaN for a list of points (one row
/// or column) where neither says anything. Throws as read_cloud().
LoadedCloud read_ptx(const InputFile& file);

}  // namespace pcednet::io
