#pragma once

#include <filesystem>
#include <memory>
#include <string>
#include <string_view>
#include <vector>

#include "pcednet/io/coordinate_system.h"
#include "pcednet/io/input_file.h"
#include "pcednet/io/loaded_cloud.h"
#include "pcednet/io/parts.h"
#include "pcednet/io/write_options.h"

namespace pcednet::io {

/// Whether a file with this beginning is LAS or LAZ.
bool begins_as_las(std::string_view start);

/// Reads LAS 1.0 to 1.5 (ASPRS), point formats 0 to 10, and their LASzip compressed form.
///
/// Every field becomes an attribute in its own type: Intensity, ReturnNumber, ..., GpsTime, Red,
/// Green, Blue; extra bytes under their own names, not scaled. Red, Green and Blue also give the
/// colours (divided by 257 unless all are below 256), NormalX, NormalY and NormalZ the normals.
/// Header and records travel with the cloud for write_las. Throws as read_cloud.
LoadedCloud read_las(const InputFile& file);

/// For open_parts().
std::unique_ptr<PartReader> open_las_parts(std::unique_ptr<InputFile> file, std::size_t most);

/// Writes LAS, or LAZ if `path` ends in .laz, or COPC 1.0 if it ends in .copc.laz.
///
/// A cloud that was read from LAS keeps version, point format, scale, offset, records and fields,
/// its integers bit for bit, without the extra bytes that it lost since; any other becomes LAS 1.4,
/// point format 6, or 7 with colours, in steps of a power of ten of at most 0.1 mm. COPC is always
/// LAS 1.4 of point format 6, 7 or 8, with its points reordered. Attributes of any type with the
/// name of a field, in any capitals, go into it if it holds all their values. Others become extra
/// bytes: scalar_edge_class, scalar_p_sharp and scalar_p_smooth as edge_class, p_sharp and
/// p_smooth, names of more than 32 bytes cut. Throws Error(kInsufficient) for coordinates so far
/// apart that steps would be above 1. append() throws Error(kInsufficient) for positions
/// that are not finite, Error(kFailure) for a number that its field cannot hold; both name the
/// point.
std::unique_ptr<PartWriter> create_las_parts(const std::filesystem::path& path,
                                             const PartOutline& outline,
                                             const WriteOptions& options);

/// Throws the error of append() for the first position that cannot be written.
void check_las_positions(const std::filesystem::path& path, const PointCloud& cloud);

/// The coordinate system of a cloud that was read from LAS, or from a PLY file made from one: that
/// of its WKT, otherwise of its GeoTIFF keys. Where these state no unit, or the WKT no code, it is
/// the one that PROJ knows. Of any other cloud, that of its comments, as E57 has.
CoordinateSystem las_coordinate_system(const PointCloud& cloud);

/// The losses, as phrases, of a format that keeps neither header nor records of LAS: the coordinate
/// system, by its EPSG code if it has one, and the others. None if the cloud has no such elements.
std::vector<std::string> las_element_losses(const PointCloud& cloud);

/// The parts of `cloud` that create_las_parts() does not keep, as phrases.
std::vector<std::string> las_losses(const std::filesystem::path& path, const PointCloud& cloud);

}  // namespace pcednet::io
