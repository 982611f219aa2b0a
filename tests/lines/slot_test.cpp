#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <numbers>
#include <vector>

#include "pcednet/core/random.h"
#include "pcednet/lines/find_lines.h"

namespace pcednet::lines {
namespace {

constexpr double kHalfSlot = 10.0, kSlotDepth = 8.0, kSlotPlate = 50.0;  // in spacings

/// Distance from the middle line of a slot along x.
double from_middle_line(const Vec3& p) {
  return std::hypot(std::max(0.0, std::abs(p.x()) - kHalfSlot), p.y());
}

/// The curves around a slot through a plate's top at z = 0, one point per unit of area.
std::vector<Curve> lines_of_slot(double radius, std::uint64_t seed) {
  Random random(seed);
  std::vector<Vec3> positions, normals;
  std::vector<std::uint8_t> classes;
  const auto add = [&](const Vec3& place, const Vec3& normal) {
    positions.push_back(place);
    normals.push_back(normal);
    classes.push_back(std::hypot(from_middle_line(place) - radius, place.z()) < 0.8 ? kSharpEdge
                                                                                    : kNonEdge);
  };
  for (int i = 0; i < static_cast<int>(kSlotPlate * kSlotPlate); ++i) {
    const double x = random.uniform() - 0.5, y = random.uniform() - 0.5;
    const Vec3 place(kSlotPlate * x, kSlotPlate * y, 0.0);
    if (from_middle_line(place) > radius) add(place, Vec3::UnitZ());
  }
  const double line = 2.0 * kHalfSlot, arc = std::numbers::pi * radius, around = 2.0 * (line + arc);
  for (int i = 0; i < static_cast<int>(around * kSlotDepth); ++i) {
    const double along = 0.5 * around * random.uniform(), z = -kSlotDepth * random.uniform();
    const double sign = random.uniform() < 0.5 ? 1.0 : -1.0;
    const double angle = std::max(0.0, along - line) / radius - 0.5 * std::numbers::pi;
    const Vec3 out(std::cos(angle), std::sin(angle), 0.0);
    const Vec3 centre(along < line ? along - kHalfSlot : kHalfSlot, 0.0, z);
    const Vec3 place = centre + radius * out;
    add({sign * place.x(), sign * place.y(), z}, {-sign * out.x(), -sign * out.y(), 0.0});
  }
  return find_lines({positions, normals, classes});
}

TEST(Slot, HasArcsAtItsEndsNotCircles) {
  std::size_t arcs = 0;
  for (const double radius : {3.0, 4.0, 5.0}) {
    for (const std::uint64_t seed : {1u, 2u, 3u}) {
      for (const Curve& curve : lines_of_slot(radius, seed)) {
        EXPECT_NE(curve.kind, CurveKind::kCircle) << radius << " " << seed;
        arcs += curve.kind == CurveKind::kArc;
      }
    }
  }
  EXPECT_GE(arcs, 17u);  // of 18
}

}  // namespace
}  // namespace pcednet::lines
