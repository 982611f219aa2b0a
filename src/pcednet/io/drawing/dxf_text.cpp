#include "pcednet/io/drawing/dxf_text.h"

#include <fmt/format.h>
#include <Eigen/Geometry>
#include <cmath>
#include <string_view>

#include "pcednet/io/drawing/line_classes.h"
#include "pcednet/io/drawing/writers.h"

namespace pcednet::io {
namespace {

std::uint64_t begin_table(DxfText& dxf, std::string_view name, long entries) {
  const std::uint64_t own = dxf.reserve();
  dxf.text(0, "TABLE");
  dxf.text(2, name);
  dxf.handle(5, own);
  dxf.handle(330, 0);
  dxf.subclass("AcDbSymbolTable");
  dxf.integer(70, entries);
  return own;
}

void end_table(DxfText& dxf) {
  dxf.text(0, "ENDTAB");
}

std::uint64_t begin_entry(DxfText& dxf, std::string_view type, std::uint64_t table,
                          std::string_view subclass, std::string_view name) {
  const std::uint64_t own = dxf.begin(type, table, type == "DIMSTYLE" ? 105 : 5);
  dxf.subclass("AcDbSymbolTableRecord");
  dxf.subclass(subclass);
  dxf.text(2, name);
  return own;
}

void write_empty_table(DxfText& dxf, std::string_view name) {
  begin_table(dxf, name, 0);
  end_table(dxf);
}

/// The view from above that shows the whole drawing.
void write_views(DxfText& dxf, const BoundingBox& box) {
  const std::uint64_t table = begin_table(dxf, "VPORT", 1);
  begin_entry(dxf, "VPORT", table, "AcDbViewportTableRecord", "*ACTIVE");
  dxf.integer(70, 0);
  const Vec3 centre = box.empty() ? Vec3::Zero() : box.centre();
  const Vec3 size = box.empty() ? Vec3::Ones() : Vec3(box.max - box.min);
  const auto pair = [&](int code, double x, double y) {
    dxf.number(code, x);
    dxf.number(code + 10, y);
  };
  pair(10, 0.0, 0.0);
  pair(11, 1.0, 1.0);
  pair(12, centre.x(), centre.y());
  pair(13, 0.0, 0.0);
  pair(14, 1.0, 1.0);
  pair(15, 1.0, 1.0);
  dxf.point(16, Vec3::UnitZ());
  dxf.point(17, Vec3::Zero());
  constexpr double kAspect = 1.5;
  const double height = 1.05 * std::max(size.y(), size.x() / kAspect);
  dxf.number(40, height > 0.0 ? height : 1.0);
  dxf.number(41, kAspect);
  dxf.number(42, 50.0);
  for (const int code : {43, 44, 50, 51}) dxf.number(code, 0.0);
  constexpr std::pair<int, long> kSettings[] = {{71, 0}, {72, 100}, {73, 1}, {74, 3},
                                                {75, 0}, {76, 0},   {77, 0}, {78, 0}};
  for (const auto& [code, value] : kSettings) dxf.integer(code, value);
  end_table(dxf);
}

void write_line_types(DxfText& dxf) {
  const bool all = dxf.has_handles();
  const std::uint64_t table = begin_table(dxf, "LTYPE", all ? 3 : 1);
  for (const std::string_view name : {"ByBlock", "ByLayer", "Continuous"}) {
    if (!all && name != "Continuous") continue;
    begin_entry(dxf, "LTYPE", table, "AcDbLinetypeTableRecord", all ? name : "CONTINUOUS");
    dxf.integer(70, 0);
    dxf.text(3, name == "Continuous" ? "Solid line" : "");
    dxf.integer(72, 65);
    dxf.integer(73, 0);
    dxf.number(40, 0.0);
  }
  end_table(dxf);
}

void write_layers(DxfText& dxf) {
  const std::uint64_t table = begin_table(dxf, "LAYER", 1 + long{kLineClasses.size()});
  const auto write = [&](std::string_view name, int colour) {
    begin_entry(dxf, "LAYER", table, "AcDbLayerTableRecord", name);
    dxf.integer(70, 0);
    dxf.integer(62, colour);
    dxf.text(6, dxf.has_handles() ? "Continuous" : "CONTINUOUS");
  };
  write("0", 7);
  for (const LineClass& entry : kLineClasses) write(entry.name, entry.dxf_colour);
  end_table(dxf);
}

void write_styles(DxfText& dxf) {
  const std::uint64_t table = begin_table(dxf, "STYLE", 1);
  begin_entry(dxf, "STYLE", table, "AcDbTextStyleTableRecord", "Standard");
  dxf.integer(70, 0);
  dxf.number(40, 0.0);
  dxf.number(41, 1.0);
  dxf.number(50, 0.0);
  dxf.integer(71, 0);
  dxf.number(42, 2.5);
  dxf.text(3, "txt");
  dxf.text(4, "");
  end_table(dxf);
}

void write_applications(DxfText& dxf) {
  const std::uint64_t table = begin_table(dxf, "APPID", 2);
  for (const std::string_view name : {std::string_view("ACAD"), kDxfApplication}) {
    begin_entry(dxf, "APPID", table, "AcDbRegAppTableRecord", name);
    dxf.integer(70, 0);
  }
  end_table(dxf);
}

void write_dimension_styles(DxfText& dxf) {
  const std::uint64_t table = begin_table(dxf, "DIMSTYLE", 1);
  dxf.subclass("AcDbDimStyleTable");
  begin_entry(dxf, "DIMSTYLE", table, "AcDbDimStyleTableRecord", "Standard");
  dxf.integer(70, 0);
  end_table(dxf);
}

DxfHandles write_block_records(DxfText& dxf) {
  DxfHandles handles;
  const std::uint64_t table = begin_table(dxf, "BLOCK_RECORD", 2);
  const auto write = [&](std::string_view name) {
    return begin_entry(dxf, "BLOCK_RECORD", table, "AcDbBlockTableRecord", name);
  };
  handles.model_space = write("*Model_Space");
  handles.paper_space = write("*Paper_Space");
  end_table(dxf);
  return handles;
}

}  // namespace

void DxfText::text(int code, std::string_view value) {
  bytes_ += fmt::format("{:3}\n{}\n", code, value);
}

void DxfText::integer(int code, long value) {
  bytes_ += fmt::format("{:3}\n{}\n", code, value);
}

void DxfText::number(int code, double value) {
  text(code, real_digits(value));
}

void DxfText::point(int code, const Vec3& value) {
  for (int axis = 0; axis < 3; ++axis) number(code + 10 * axis, value[axis]);
}

void DxfText::handle(int code, std::uint64_t value) {
  if (has_handles()) text(code, fmt::format("{:X}", value));
}

void DxfText::subclass(std::string_view name) {
  if (has_handles()) text(100, name);
}

std::uint64_t DxfText::begin(std::string_view type, std::uint64_t owner, int handle_code) {
  const std::uint64_t own = reserve();
  text(0, type);
  handle(handle_code, own);
  handle(330, owner);
  return own;
}

std::uint64_t DxfText::begin_drawn(std::string_view type, std::uint64_t owner,
                                   std::string_view layer) {
  const std::uint64_t own = begin(type, owner);
  subclass("AcDbEntity");
  text(8, layer);
  return own;
}

void DxfText::begin_at(std::string_view type, std::uint64_t own, std::uint64_t owner) {
  text(0, type);
  handle(5, own);
  handle(330, owner);
}

void DxfText::begin_section(std::string_view name) {
  text(0, "SECTION");
  text(2, name);
}

Mat3 dxf_plane_axes(const Vec3& normal) {
  const bool is_upright = std::abs(normal.x()) < 1.0 / 64.0 && std::abs(normal.y()) < 1.0 / 64.0;
  const Vec3 x = (is_upright ? Vec3::UnitY() : Vec3::UnitZ()).cross(normal).normalized();
  Mat3 axes;
  axes << x, normal.cross(x).normalized(), normal;
  return axes;
}

DxfHandles write_dxf_tables(DxfText& dxf, const BoundingBox& box) {
  DxfHandles handles;
  dxf.begin_section("TABLES");
  write_views(dxf, box);
  write_line_types(dxf);
  write_layers(dxf);
  if (dxf.has_handles()) {
    write_styles(dxf);
    write_empty_table(dxf, "VIEW");
    write_empty_table(dxf, "UCS");
  }
  write_applications(dxf);
  if (dxf.has_handles()) {
    write_dimension_styles(dxf);
    handles = write_block_records(dxf);
  }
  dxf.end_section();
  return handles;
}

void write_dxf_blocks(DxfText& dxf, const DxfHandles& handles) {
  dxf.begin_section("BLOCKS");
  const std::pair<std::string_view, std::uint64_t> blocks[] = {
      {"*Model_Space", handles.model_space}, {"*Paper_Space", handles.paper_space}};
  for (const auto& [name, record] : blocks) {
    dxf.begin_drawn("BLOCK", record, "0");
    dxf.subclass("AcDbBlockBegin");
    dxf.text(2, name);
    dxf.integer(70, 0);
    dxf.point(10, Vec3::Zero());
    dxf.text(3, name);
    dxf.text(1, "");
    dxf.begin_drawn("ENDBLK", record, "0");
    dxf.subclass("AcDbBlockEnd");
  }
  dxf.end_section();
}

void write_dxf_objects(DxfText& dxf) {
  dxf.begin_section("OBJECTS");
  const std::uint64_t root = dxf.begin("DICTIONARY", 0);
  const std::uint64_t groups = dxf.reserve();
  dxf.subclass("AcDbDictionary");
  dxf.integer(281, 1);
  dxf.text(3, "ACAD_GROUP");
  dxf.handle(350, groups);
  dxf.begin_at("DICTIONARY", groups, root);
  dxf.subclass("AcDbDictionary");
  dxf.integer(281, 1);
  dxf.end_section();
}

}  // namespace pcednet::io
