#pragma once

#include <filesystem>
#include <span>
#include <string>
#include <vector>

#include "pcednet/cloud/bounding_box.h"
#include "pcednet/io/drawing/drawing.h"

namespace pcednet::io {

// One file per format; called by write_drawing(), which has checked the curves.
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

/// Whether a curve is an arc or a circle, and one that is not horizontal within its tolerance.
bool is_round(const lines::Curve& curve);
bool is_tilted(const lines::Curve& curve, const DrawingOptions& options);

/// The vertices of a curve for a format without arcs.
std::vector<Vec3> drawn(const lines::Curve& curve, const DrawingOptions& options);

/// The curves as polylines that share their vertices.
struct LineMesh {
  std::vector<Vec3> vertices;  ///< no two at one place
  std::vector<std::vector<std::size_t>>
      chains;  ///< of each curve; a closed one ends with its first vertex
};
LineMesh line_mesh(Curves curves, const DrawingOptions& options);

/// The box of everything drawn.
BoundingBox drawn_box(Curves curves, const DrawingOptions& options);

/// The shortest digits that read back exactly, with a point or an exponent, by which some readers
/// recognise a real.
std::string real_digits(double value);

/// Adds the bytes of a number, little-endian.
template <typename T>
void append_little(std::string& bytes, T value) {
  bytes.append(reinterpret_cast<const char*>(&value), sizeof value);
}

double dihedral_degrees(const lines::Curve& curve);

}  // namespace pcednet::io
