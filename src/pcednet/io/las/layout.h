#pragma once

#include <cstddef>
#include <filesystem>
#include <optional>
#include <string>
#include <vector>

#include "pcednet/io/las/file.h"
#include "pcednet/io/las/sources.h"
#include "pcednet/io/parts.h"

namespace pcednet::io {

/// A field of the records to write, and the source of its numbers.
struct LasColumn {
  enum class Scale { kNone, kCast, kColour, kNormal, kAngle };
  LasField field = {};
  const std::byte* first = nullptr;  ///< the number of point 0
  std::size_t stride = 0;            ///< bytes from point to point; 0: the same for all points
  Scale scale = Scale::kNone;        ///< of another type, bytes times 257, unit normals, degrees
  ScalarType stored = ScalarType::kFloat64;  ///< kCast and kAngle: the type of the numbers
};

/// The decisions that depend on all points.
struct LasChoices {
  LasFile file = {};                     ///< version, point format, scale, offset; all records
  bool is_new = false;                   ///< the cloud does not come from LAS
  LasSources sources = {};               ///< of standard fields
  bool new_colours = false;              ///< the colours are not those of Red, Green and Blue
  bool label_is_class = false;           ///< the labels add nothing to scalar_edge_class
  bool promoted = false;                 ///< the point format is not that of the input
  bool exact = true;                     ///< every coordinate reads back exactly
  std::vector<std::string> losses = {};  ///< anything else that the version cannot hold
};
LasChoices las_choices(const std::filesystem::path& path, const PartOutline& outline);

/// The parts of the cloud that LAS loses, names of attributes aside; see losses().
std::vector<std::string> las_losses(const PointCloud& first, const LasChoices& choices);

/// How a part is laid out as LAS: the header, as far as it does not depend on the points, the
/// records about the file, the columns. Points into the part.
struct LasLayout {
  LasFile file = {};
  std::vector<LasColumn> columns;        ///< all but X, Y and Z
  std::vector<std::string> losses = {};  ///< names that LAS has no room for
};
LasLayout las_layout(const PointCloud& part, const WriteOptions& options,
                     const LasChoices& choices);

/// The whole number of scale steps for a coordinate; NaN if 32 bits cannot hold it.
double las_step(const LasFile& file, std::size_t axis, double coordinate);

/// Writes one number of a column that is not copied verbatim.
void write_scaled(const LasColumn& column, const std::byte* from, char* to);

/// The comments of a cloud as a record of user id "pcednet", number 1: lines of UTF-8 text. None if
/// there are no comments, or more than the 64 KiB of a record.
std::optional<LasRecord> las_comment_record(const std::vector<std::string>& comments);

/// Removes such records from a file and returns their lines, control characters as blanks.
std::vector<std::string> take_las_comments(LasFile& file);

}  // namespace pcednet::io
