#pragma once

#include <cstddef>
#include <span>
#include <string>
#include <vector>

#include "pcednet/io/las/file.h"

namespace pcednet::io {

/// Makes a file LAS 1.4 of point format `format`, 6 to 8: its extra bytes stay, and WKT names its
/// coordinate system, too. Returns what gets lost, as phrases.
std::vector<std::string> promote_las(LasFile& file, unsigned format);

/// Header and records for points that come from several files, at least one: those of the first,
/// with the fields of all. Where point formats differ, the format is the first of 0 to 3 that has
/// the fields of all, or of 6 to 8 if one of the files has such. Extra bytes are those of all, of
/// equal names the first; all must be described. The coordinate system is
/// that of the first file that names it with heights, otherwise of the first that names one. GPS
/// times count as in number `timed` of the files, if by an offset (LAS 1.5) as in the first. Files
/// with waveforms must be of one format.
LasFile merge_las_files(std::span<const LasFile> files, std::size_t timed);

}  // namespace pcednet::io
