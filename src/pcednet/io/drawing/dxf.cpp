#include <Eigen/Geometry>
#include <cmath>
#include <numbers>

#include "pcednet/io/drawing/dxf_text.h"
#include "pcednet/io/drawing/line_classes.h"
#include "pcednet/io/drawing/writers.h"
#include "pcednet/io/length_units.h"

namespace pcednet::io {
namespace {

using lines::Curve;
using lines::CurveKind;

/// The attributes that DXF has no place for, as data of an application.
void write_attributes(DxfText& dxf, const Curve& curve) {
  dxf.text(1001, kDxfApplication);
  dxf.text(1000, "confidence");
  dxf.number(1040, curve.confidence);
  dxf.text(1000, "dihedral_angle");
  dxf.number(1040, dihedral_degrees(curve));
}

void write_line(DxfText& dxf, const Curve& curve, std::string_view layer, std::uint64_t owner) {
  dxf.begin_drawn("LINE", owner, layer);
  dxf.subclass("AcDbLine");
  dxf.point(10, curve.points.front());
  dxf.point(11, curve.points.back());
  write_attributes(dxf, curve);
}

/// The direction of `to` seen from the centre, in degrees of [0, 360).
double degrees_in(const Mat3& axes, const Vec3& to) {
  const Vec3 in_plane = axes.transpose() * to;
  const double degrees = std::atan2(in_plane.y(), in_plane.x()) * 180.0 / std::numbers::pi;
  return degrees < 0.0 ? degrees + 360.0 : degrees;
}

/// Whether a normal points down; of an upright plane, within the bound of the arbitrary axis
/// algorithm, to smaller y, then x.
bool is_downward(const Vec3& normal) {
  constexpr double kUpright = 1.0 / 64.0;
  if (std::abs(normal.z()) > kUpright) return normal.z() < 0.0;
  return std::abs(normal.y()) > kUpright ? normal.y() < 0.0 : normal.x() < 0.0;
}

/// DXF has the centre in the axes of the curve's plane; arcs run counter-clockwise there. The
/// normal points upwards: programs that ignore it then draw flat curves where they are.
void write_round(DxfText& dxf, const Curve& curve, std::string_view layer, std::uint64_t owner) {
  Vec3 normal = curve.axis.normalized();
  const bool turn = is_downward(normal);
  if (turn) normal = Vec3::Zero() - normal;  // no -0.0
  const Mat3 axes = dxf_plane_axes(normal);
  const bool whole =
      curve.kind == CurveKind::kCircle || curve.points.front() == curve.points.back();
  dxf.begin_drawn(whole ? "CIRCLE" : "ARC", owner, layer);
  dxf.subclass("AcDbCircle");
  dxf.point(10, axes.transpose() * curve.centre);
  dxf.number(40, curve.radius);
  dxf.point(210, normal);
  if (whole) return write_attributes(dxf, curve);
  dxf.subclass("AcDbArc");
  const Vec3& from = turn ? curve.points.back() : curve.points.front();
  const Vec3& to = turn ? curve.points.front() : curve.points.back();
  dxf.number(50, degrees_in(axes, from - curve.centre));
  dxf.number(51, degrees_in(axes, to - curve.centre));
  write_attributes(dxf, curve);
}

void write_polyline(DxfText& dxf, const Curve& curve, std::string_view layer, std::uint64_t owner) {
  constexpr long kClosed = 1, kInSpace = 8, kVertexInSpace = 32;
  const std::uint64_t own = dxf.begin_drawn("POLYLINE", owner, layer);
  dxf.subclass("AcDb3dPolyline");
  dxf.integer(66, 1);
  dxf.point(10, Vec3::Zero());
  dxf.integer(70, kInSpace | (curve.closed ? kClosed : 0));
  write_attributes(dxf, curve);
  for (const Vec3& point : curve.points) {
    dxf.begin_drawn("VERTEX", own, layer);
    dxf.subclass("AcDbVertex");
    dxf.subclass("AcDb3dPolylineVertex");
    dxf.point(10, point);
    dxf.integer(70, kVertexInSpace);
  }
  dxf.begin_drawn("SEQEND", own, layer);
}

/// The curve as the options have it: an arc or circle may become horizontal or a polyline.
Curve with_chosen_arcs(Curve curve, const DrawingOptions& options) {
  if (!is_round(curve) || options.dxf_arcs == DxfArcs::kAll) return curve;
  if (options.dxf_arcs == DxfArcs::kFlat && !is_tilted(curve, options)) {
    curve.axis = Vec3(0.0, 0.0, curve.axis.z() < 0.0 ? -1.0 : 1.0);
    return curve;
  }
  curve.points = drawn(curve, options);
  curve.closed = curve.points.front() == curve.points.back();
  if (curve.closed) curve.points.pop_back();
  curve.kind = CurveKind::kPolyline;
  return curve;
}

void write_entities(DxfText& dxf, Curves curves, const DrawingOptions& options,
                    std::uint64_t owner) {
  dxf.begin_section("ENTITIES");
  for (const Curve& given : curves) {
    const Curve curve = with_chosen_arcs(given, options);
    const std::string_view layer = line_class(curve.edge_class).name;
    switch (curve.kind) {
      case CurveKind::kSegment:
        write_line(dxf, curve, layer, owner);
        break;
      case CurveKind::kArc:
      case CurveKind::kCircle:
        write_round(dxf, curve, layer, owner);
        break;
      case CurveKind::kPolyline:
        write_polyline(dxf, curve, layer, owner);
        break;
    }
  }
  dxf.end_section();
}

void write_header(DxfText& dxf, const BoundingBox& box, const LengthUnitEntry& unit,
                  std::uint64_t next_handle) {
  const auto variable = [&](std::string_view name) { dxf.text(9, name); };
  dxf.begin_section("HEADER");
  variable("$ACADVER");
  dxf.text(1, dxf.has_handles() ? "AC1015" : "AC1009");
  if (dxf.has_handles()) {
    variable("$DWGCODEPAGE");
    dxf.text(3, "ANSI_1252");
    variable("$HANDSEED");
    dxf.handle(5, next_handle);
    variable("$INSUNITS");
    dxf.integer(70, unit.dxf_code);
    variable("$MEASUREMENT");
    dxf.integer(70, unit.imperial ? 0 : 1);
  }
  // AutoCAD's own values for an empty drawing.
  variable("$EXTMIN");
  dxf.point(10, box.empty() ? Vec3::Constant(1e20) : box.min);
  variable("$EXTMAX");
  dxf.point(10, box.empty() ? Vec3::Constant(-1e20) : box.max);
  variable("$LUNITS");
  dxf.integer(70, 2);  // decimal
  dxf.end_section();
}

}  // namespace

void write_dxf(const std::filesystem::path& path, Curves curves, const DrawingOptions& options) {
  const BoundingBox box = drawn_box(curves, options);
  DxfText body(options.dxf_version);
  if (body.has_handles()) {
    body.begin_section("CLASSES");
    body.end_section();
  }
  const DxfHandles handles = write_dxf_tables(body, box);
  if (body.has_handles()) write_dxf_blocks(body, handles);
  write_entities(body, curves, options, handles.model_space);
  if (body.has_handles()) write_dxf_objects(body);
  body.text(0, "EOF");
  DxfText header(options.dxf_version);  // names the handle after the last
  const LengthUnit unit = options.unit.value_or(options.coordinate_system.unit);
  write_header(header, box, entry_of(unit), body.next_handle());
  OutputFile file(path, options.overwrite);
  file.write(header.bytes());
  file.write(body.bytes());
  file.commit();
}

}  // namespace pcednet::io
