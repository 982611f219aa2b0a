#include <gtest/gtest.h>

#include <cmath>
#include <numbers>
#include <vector>

#include "pcednet/core/random.h"
#include "pcednet/lines/find_lines.h"

namespace pcednet::lines {
namespace {

constexpr double kMeshRadius = 15.0, kMeshDepth = 8.0, kMeshPlate = 50.0;  // in spacings

/// The curves of a bore through a plate's top at z = 0, one point per unit of area. The wall is a
/// mesh of `facets` sides.
std::vector<Curve> lines_of_bore(int facets, std::uint64_t seed) {
  Random random(seed);
  std::vector<Vec3> positions, normals;
  std::vector<std::uint8_t> classes;
  const double side = 2.0 * std::numbers::pi / facets, apothem = kMeshRadius * std::cos(side / 2.0);
  const auto facet_at = [&](double angle) { return (std::floor(angle / side) + 0.5) * side; };
  const auto add = [&](const Vec3& place, const Vec3& normal) {
    const double out = std::hypot(place.x(), place.y()) - kMeshRadius;
    positions.push_back(place);
    normals.push_back(normal);
    classes.push_back(std::hypot(out, place.z()) < 0.8 ? kSharpEdge : kNonEdge);
  };
  for (int i = 0; i < static_cast<int>(kMeshPlate * kMeshPlate); ++i) {
    const double x = kMeshPlate * (random.uniform() - 0.5);
    const double y = kMeshPlate * (random.uniform() - 0.5);
    const double facet = facet_at(std::atan2(y, x));
    if (x * std::cos(facet) + y * std::sin(facet) > apothem) add({x, y, 0.0}, Vec3::UnitZ());
  }
  const int of_wall = static_cast<int>(2.0 * std::numbers::pi * kMeshRadius * kMeshDepth);
  for (int i = 0; i < of_wall; ++i) {
    const double facet = facet_at(2.0 * std::numbers::pi * random.uniform());
    const double along = (2.0 * random.uniform() - 1.0) * kMeshRadius * std::sin(side / 2.0);
    const Vec3 out(std::cos(facet), std::sin(facet), 0.0), across(-out.y(), out.x(), 0.0);
    add(apothem * out + along * across - kMeshDepth * random.uniform() * Vec3::UnitZ(), -out);
  }
  return find_lines({positions, normals, classes});
}

TEST(BoreOfAMesh, HasOneCircle) {
  for (const int facets : {64, 80, 96, 128}) {
    for (const std::uint64_t seed : {1u, 2u, 3u, 4u, 5u, 6u}) {
      const std::vector<Curve> curves = lines_of_bore(facets, seed);
      EXPECT_EQ(curves.size(), 1u) << facets << " facets, seed " << seed;
      EXPECT_EQ(curves[0].kind, CurveKind::kCircle);
      EXPECT_NEAR(curves[0].radius, kMeshRadius, 0.03);
    }
  }
}

}  // namespace
}  // namespace pcednet::lines
