#include "pcednet/io/drawing/drawing.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <map>
#include <numbers>

#include "pcednet/core/error.h"
#include "pcednet/io/drawing/chain.h"
#include "pcednet/io/drawing/writers.h"
#include "pcednet/io/text_scan.h"

namespace pcednet::io {
namespace {

using lines::Curve;
using lines::CurveKind;

/// Why a curve cannot be drawn; empty if it can.
std::string fault_of(const Curve& curve) {
  const std::size_t least = curve.kind == CurveKind::kCircle ? 1 : 2;
  if (curve.points.size() < least) return fmt::format("has {} points", curve.points.size());
  for (const Vec3& point : curve.points) {
    if (!is_drawable(point)) return "has a point that is not finite or beyond 1e150";
  }
  if (!std::isfinite(curve.confidence) || !std::isfinite(curve.dihedral_angle)) {
    return "has a confidence or an angle that is not finite";
  }
  if (!is_round(curve)) return "";
  const bool has_place = is_drawable(curve.centre) && std::abs(curve.axis.norm() - 1.0) < 1e-6;
  if (!has_place) return "has no centre or no unit axis";
  return curve.radius > 0.0 && curve.radius <= 1e150 ? "" : "has no positive radius";
}

void check_curves(const std::filesystem::path& path, Curves curves) {
  for (std::size_t i = 0; i < curves.size(); ++i) {
    const std::string fault = fault_of(curves[i]);
    if (fault.empty()) continue;
    throw Error(ErrorKind::kFailure, fmt::format("{}: curve {} ({}) {}", path.string(), i,
                                                 name_of(curves[i].kind), fault));
  }
}

}  // namespace

std::span<const DrawingFormat> drawing_formats() {
  static constexpr std::array<DrawingFormat, 6> kFormats = {{
      {"DXF", ".dxf", write_dxf},
      {"OBJ", ".obj", write_obj_lines},
      {"PLY", ".ply", write_ply_edges},
      {"GeoJSON", ".geojson", write_geojson},
      {"GeoPackage", ".gpkg", write_geopackage},
      {"SVG", ".svg", write_svg},
  }};
  return kFormats;
}

std::string drawing_extensions(std::string_view last) {
  std::string list;
  for (const DrawingFormat& format : drawing_formats()) {
    const bool is_last = &format == &drawing_formats().back();
    list += fmt::format("{}{}", list.empty() ? "" : is_last ? last : " ", format.extension);
  }
  return list;
}

const DrawingFormat& drawing_format_for(const std::filesystem::path& path) {
  const std::string extension = extension_of(path);
  for (const DrawingFormat& format : drawing_formats()) {
    if (format.extension != extension) continue;
    if (format.write == write_geopackage && !has_geopackage()) {
      throw Error(ErrorKind::kUsage,
                  fmt::format("{}: this build has no GeoPackage: it was made without SQLite",
                              path.string()));
    }
    return format;
  }
  throw Error(ErrorKind::kUsage, fmt::format("{}: lines are written as {}", path.string(),
                                             drawing_extensions(" or ")));
}

void write_drawing(const std::filesystem::path& path, Curves curves,
                   const DrawingOptions& options) {
  const DrawingFormat& format = drawing_format_for(path);
  check_writable(path, options.overwrite);
  check_curves(path, curves);
  format.write(path, curves, options);
}

std::vector<std::string> drawing_losses(const std::filesystem::path& path,
                                        const DrawingOptions& options) {
  const bool is_geojson = drawing_format_for(path).write == write_geojson;
  const CoordinateSystem& system = options.coordinate_system;
  if (!is_geojson || system.epsg > 0 || system.geographic) return {};
  return {
      "that its coordinates are lengths: without an EPSG code, readers take them for degrees of "
      "WGS 84; GeoPackage avoids that"};
}

double tolerance_of(const Curve& curve, const DrawingOptions& options) {
  if (options.tolerance > 0.0) return options.tolerance;
  const double of_radius = curve.radius / 1000.0;
  return options.fit_tolerance > 0.0 ? std::min(of_radius, options.fit_tolerance) : of_radius;
}

bool is_round(const Curve& curve) {
  return curve.kind == CurveKind::kArc || curve.kind == CurveKind::kCircle;
}

bool is_tilted(const Curve& curve, const DrawingOptions& options) {
  const double rise = curve.radius * curve.axis.head<2>().norm();
  return is_round(curve) && rise > tolerance_of(curve, options);
}

std::size_t count_tilted(Curves curves, const DrawingOptions& options) {
  return static_cast<std::size_t>(std::count_if(
      curves.begin(), curves.end(), [&](const Curve& curve) { return is_tilted(curve, options); }));
}

std::vector<Vec3> drawn(const Curve& curve, const DrawingOptions& options) {
  return sampled(curve, tolerance_of(curve, options));
}

LineMesh line_mesh(Curves curves, const DrawingOptions& options) {
  LineMesh mesh;
  std::map<std::array<double, 3>, std::size_t> places;
  for (const Curve& curve : curves) {
    std::vector<std::size_t>& chain = mesh.chains.emplace_back();
    for (const Vec3& point : drawn(curve, options)) {
      const auto [place, is_new] =
          places.try_emplace({point.x(), point.y(), point.z()}, mesh.vertices.size());
      if (is_new) mesh.vertices.push_back(point);
      chain.push_back(place->second);
    }
  }
  return mesh;
}

BoundingBox drawn_box(Curves curves, const DrawingOptions& options) {
  BoundingBox box;
  for (const Curve& curve : curves) {
    for (const Vec3& point : drawn(curve, options)) box.add(point);
  }
  return box;
}

std::string real_digits(double value) {
  const std::string digits = fmt::format("{}", value);
  return digits.find_first_of(".e") == std::string::npos ? digits + ".0" : digits;
}

double dihedral_degrees(const Curve& curve) {
  return curve.dihedral_angle * 180.0 / std::numbers::pi;
}

}  // namespace pcednet::io
