#pragma once

#include <cstdint>
#include <filesystem>
#include <span>
#include <string>
#include <vector>

#include "pcednet/cloud/bounding_box.h"
#include "pcednet/cloud/point_cloud.h"
#include "pcednet/core/output_file.h"
#include "pcednet/io/coordinate_system.h"

namespace pcednet::formats {

/// The entry of a virtual point cloud for one of its files.
struct VirtualFile {
  struct Field {
    std::string name;  ///< PDAL's name
    ScalarType type = ScalarType::kFloat64;
  };

  std::filesystem::path path;
  std::uint64_t points = 0;
  BoundingBox bounds = {};
  io::CoordinateSystem coordinate_system = {};
  std::string encoding = "?";                  ///< "las", "laz" or "copc"
  unsigned created_day = 0, created_year = 0;  ///< 0: unknown
  std::vector<Field> fields = {};
};

/// Whether a file of that name is a virtual point cloud: .vpc, in small letters or capitals.
bool is_virtual_cloud(const std::filesystem::path& path);

/// The files that a virtual point cloud names, in its order. Throws Error(kUnreadable) if it is not
/// a virtual point cloud or names a missing or a remote file, Error(kInsufficient) if it names
/// none.
std::vector<std::filesystem::path> files_of_virtual_cloud(const std::filesystem::path& path);

/// Reads the header of a LAS, LAZ or COPC file, not its points. Throws Error(kUnreadable) as
/// read_cloud, Error(kInsufficient) for another format.
VirtualFile virtual_file(const std::filesystem::path& path);

/// Writes a virtual point cloud (.vpc), as QGIS and pdal_wrench read it: a STAC ItemCollection with
/// one item per file, which it names relative to its own folder. Files without points are left out.
/// Returns notes for the user, one sentence each.
///
/// Outlines are in WGS 84 where PROJ knows the system; otherwise they are in the coordinates of the
/// files and the system is left out, because with it QGIS would take them for WGS 84. Throws
/// Error(kInsufficient) if no file has points, Error(kUsage) for a name that is not UTF-8, and as
/// OutputFile does.
std::vector<std::string> write_virtual_cloud(const std::filesystem::path& path,
                                             std::span<const VirtualFile> files,
                                             Overwrite overwrite = Overwrite::kNo);

}  // namespace pcednet::formats
