#pragma once

#include <cstddef>
#include <vector>

#include "pcednet/io/las_file.h"
#include "pcednet/io/write_cloud.h"

namespace pcednet::io {

/// A field of the records to write, and where its numbers come from.
struct LasColumn {
  enum class Scale { kNone, kColour, kNormal };
  LasField field = {};
  const std::byte* first = nullptr;  ///< what point 0 gets
  std::size_t stride = 0;            ///< bytes from point to point; 0: all get the same
  Scale scale = Scale::kNone;        ///< bytes times 257, or double to the field's float
};

/// How a cloud is laid out as LAS: the header as far as the points do not decide on it, the records
/// about the file, the columns. Points into the cloud.
struct LasLayout {
  LasFile file = {};
  std::vector<LasColumn> columns;  ///< all but X, Y and Z
};
LasLayout las_layout(const PointCloud& cloud, const WriteOptions& options);

/// The number of scale steps, whole, that stands for a coordinate; NaN if 32 bits cannot hold it.
double las_step(const LasFile& file, std::size_t axis, double coordinate);

/// One number of a column that is not copied as it is.
void write_scaled(const LasColumn& column, const std::byte* from, char* to);

}  // namespace pcednet::io
