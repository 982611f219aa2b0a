#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <map>
#include <string>
#include <string_view>
#include <vector>

#include "pcednet/cloud/bounding_box.h"
#include "pcednet/io/coordinate_system.h"
#include "pcednet/io/input_file.h"
#include "pcednet/io/las/file.h"

namespace pcednet::io {

/// The number of classes that the standard names.
inline constexpr std::size_t kLasClasses = 23;

/// The name of a class, such as "ground", in any point format; empty if it has none.
std::string_view las_class_name(unsigned code);

/// The same in this point format: 8 and 12 have names up to format 5, others from 10 on above.
std::string_view las_class_name(unsigned code, unsigned point_format);

/// The information in a LAS or LAZ file beside its points, for people.
struct LasFacts {
  struct Record {
    std::string user_id;
    std::uint16_t record_id = 0;
    std::string description;
    std::size_t bytes = 0;
  };

  unsigned minor_version = 0;  ///< of LAS 1
  unsigned point_format = 0;
  bool compressed = false, copc = false;
  std::string system, software;
  unsigned created_day = 0, created_year = 0;
  std::array<double, 3> scale = {}, offset = {};
  std::string code;               ///< of the coordinate system, see code_text(); may be empty
  std::string coordinate_system;  ///< the WKT, or the citations of GeoTIFF keys; may be empty
  std::vector<Record> records;    ///< extended ones last
  std::vector<std::string> extra_bytes;
  std::map<int, std::size_t> points_by_return, points_by_class;
};

/// The description of the points in the header and the records of a LAS or LAZ file.
struct LasOutline {
  std::uint64_t points = 0;
  BoundingBox bounds = {};  ///< empty if those of the header are none
  bool compressed = false, copc = false;
  unsigned created_day = 0, created_year = 0;  ///< 0: not stated
  CoordinateSystem coordinate_system = {};
  std::vector<LasField> fields = {};  ///< X, Y and Z first, extra bytes last
};

/// Reads no points. Throws Error(kUnreadable) as read_las.
LasOutline las_outline(const InputFile& file);

/// Reads the header and the records, no points. Throws as read_las.
LasFacts las_facts(const InputFile& file);

/// Counts the points of read_las(), or of one part.
void count_points(const PointCloud& points, LasFacts& facts);

/// The points that are marked as deleted, by the field Withheld of a cloud of any format.
std::size_t count_withheld(const PointCloud& points);

/// A note for the user that `withheld` of `points` points are withheld; empty if none is.
std::string note_on_withheld(std::size_t withheld, std::size_t points);

}  // namespace pcednet::io
