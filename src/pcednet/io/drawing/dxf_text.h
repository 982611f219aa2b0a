#pragma once

#include <cstdint>
#include <string>
#include <string_view>

#include "pcednet/cloud/bounding_box.h"
#include "pcednet/core/vec3.h"
#include "pcednet/io/drawing/drawing.h"

namespace pcednet::io {

/// The text of a DXF file under construction: group codes, values and, where the version has them,
/// handles.
class DxfText {
 public:
  explicit DxfText(DxfVersion version) : version_(version) {}

  bool has_handles() const { return version_ == DxfVersion::k2000; }

  void text(int code, std::string_view value);
  void integer(int code, long value);
  void number(int code, double value);
  /// x, y and z under `code`, `code` + 10 and `code` + 20.
  void point(int code, const Vec3& value);
  void handle(int code, std::uint64_t value);
  /// A marker of AutoCAD's classes, where the version has them.
  void subclass(std::string_view name);

  /// Begins an object of a type under a handle of its own, which it returns.
  std::uint64_t begin(std::string_view type, std::uint64_t owner, int handle_code = 5);
  /// The same for one that is drawn, on its layer.
  std::uint64_t begin_drawn(std::string_view type, std::uint64_t owner, std::string_view layer);

  /// Puts an object where its handle was reserved.
  void begin_at(std::string_view type, std::uint64_t own, std::uint64_t owner);
  std::uint64_t reserve() { return next_handle_++; }

  void begin_section(std::string_view name);
  void end_section() { text(0, "ENDSEC"); }

  const std::string& bytes() const { return bytes_; }
  std::uint64_t next_handle() const { return next_handle_; }

 private:
  DxfVersion version_;
  std::string bytes_ = {};
  std::uint64_t next_handle_ = 1;
};

/// The name under which the attributes of curves stand.
inline constexpr std::string_view kDxfApplication = "PCEDNET";

/// The axes of the plane with that normal, unit: DXF's arbitrary axis algorithm. Columns x, y, z.
Mat3 dxf_plane_axes(const Vec3& normal);

/// Handles that objects of several sections need.
struct DxfHandles {
  std::uint64_t model_space = 0, paper_space = 0;  ///< their block records
};

/// Tables of line types, layers, applications and, from 2000 on, all others; the active view shows
/// `box`.
DxfHandles write_dxf_tables(DxfText& dxf, const BoundingBox& box);

/// The blocks and objects that a drawing must have from 2000 on.
void write_dxf_blocks(DxfText& dxf, const DxfHandles& handles);
void write_dxf_objects(DxfText& dxf);

}  // namespace pcednet::io
