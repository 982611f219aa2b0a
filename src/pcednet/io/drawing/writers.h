#pragma once

#include <filesystem>
#include <span>
#include <string>
#include <vector>

#include "pcednet/cloud/bounding_box.h"
#include "pcednet/io/drawing/drawing.h"

namespace pcednet::io {

// One file each; for write_drawing(), which has checked the curves.
using Curves = std::span<const lines::Curve>;
void write_dxf(const std::filesystem::path& path, Curves curves, const DrawingOptions& options);
void write_obj_lines(const std::filesystem::path& path, Curves curves,
                     const DrawingOptions& options);
void write_ply_edges(const std::filesystem::path& path, Curves curves,
                     const DrawingOptions& options);
void write_geojson(const std::filesystem::path& path, Curves curves, const DrawingOptions& options);
void write_geopackage(const std::filesystem::path& path, Curves curves,
                      const DrawingOptions& options);
void write_svg(const std::filesystem::path& path, Curves curves, const DrawingOptions& options);

/// Whether this build can write GeoPackage.
bool has_geopackage();

/// The vertices of a curve for a format without arcs.
std::vector<Vec3> drawn(const lines::Curve& curve, const DrawingOptions& options);

/// The curves as polylines that share their vertices.
struct LineMesh {
  std::vector<Vec3> vertices;                    ///< no two at one place
  std::vector<std::vector<std::size_t>> chains;  ///< of each curve; a closed one ends as it began
};
LineMesh line_mesh(Curves curves, const DrawingOptions& options);

/// The box of all that is drawn.
BoundingBox drawn_box(Curves curves, const DrawingOptions& options);

/// The shortest digits that give back the number, with a point or an exponent: some readers know a
/// real by it.
std::string real_digits(double value);

double dihedral_degrees(const lines::Curve& curve);

}  // namespace pcednet::io
