#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <map>
#include <string>
#include <vector>

#include "pcednet/io/input_file.h"
#include "pcednet/io/las/file.h"

namespace pcednet::io {

/// What a LAS or LAZ file says beside its points, for people.
struct LasFacts {
  struct Record {
    std::string user_id;
    std::uint16_t record_id = 0;
    std::string description;
    std::size_t bytes = 0;
  };

  unsigned minor_version = 0;  ///< of LAS 1
  unsigned point_format = 0;
  bool compressed = false;
  std::string system, software;
  unsigned created_day = 0, created_year = 0;
  std::array<double, 3> scale = {}, offset = {};
  std::string coordinate_system;  ///< the WKT, or the citations of GeoTIFF keys; may be empty
  std::vector<Record> records;    ///< extended ones last
  std::vector<std::string> extra_bytes;
  std::map<int, std::size_t> points_by_return, points_by_class;
};

/// Reads the header and the records; the points are those that read_las gives. Throws as it.
LasFacts las_facts(const InputFile& file, const PointCloud& points);

}  // namespace pcednet::io
