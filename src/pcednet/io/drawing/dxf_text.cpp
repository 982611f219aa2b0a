#include "pcednet/io/drawing/dxf_text.h"

#include <fmt/format.h>

#include <Eigen/Geometry>
#include <cmath>

#include "pcednet/io/drawing/writers.h"

namespace pcednet::io {

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

}  // namespace pcednet::io
