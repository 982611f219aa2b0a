#pragma once

#include <cstddef>
#include <filesystem>
#include <string>
#include <vector>

#include "pcednet/io/las/file.h"
#include "pcednet/io/parts.h"

namespace pcednet::io {

/// A field of the records to write, and where its numbers come from.
struct LasColumn {
  enum class Scale { kNone, kColour, kNormal, kAngle };
  LasField field = {};
  const std::byte* first = nullptr;  ///< what point 0 gets
  std::size_t stride = 0;            ///< bytes from point to point; 0: all get the same
  Scale scale = Scale::kNone;        ///< bytes times 257, unit normals, whole degrees
};

/// What all points together decide.
struct LasChoices {
  LasFile file = {};                     ///< version, point format, scale, offset; all records
  bool new_colours = false;              ///< the colours are not those of Red, Green and Blue
  bool label_is_class = false;           ///< the labels say nothing that scalar_edge_class does not
  bool promoted = false;                 ///< the point format is not that of the input
  bool exact = true;                     ///< every coordinate comes back as it is
  std::vector<std::string> losses = {};  ///< what else the version does not hold
};
LasChoices las_choices(const std::filesystem::path& path, const PartOutline& outline);

/// What LAS loses of the cloud; see losses().
std::vector<std::string> las_losses(const PointCloud& first, const LasChoices& choices);

/// How a part is laid out as LAS: the header as far as the points do not decide on it, the records
/// about the file, the columns. Points into the part.
struct LasLayout {
  LasFile file = {};
  std::vector<LasColumn> columns;  ///< all but X, Y and Z
};
LasLayout las_layout(const PointCloud& part, const WriteOptions& options,
                     const LasChoices& choices);

/// The number of scale steps, whole, that stands for a coordinate; NaN if 32 bits cannot hold it.
double las_step(const LasFile& file, std::size_t axis, double coordinate);

/// One number of a column that is not copied as it is.
void write_scaled(const LasColumn& column, const std::byte* from, char* to);

}  // namespace pcednet::io
