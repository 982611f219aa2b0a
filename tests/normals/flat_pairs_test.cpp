#include "pcednet/normals/flat_pairs.h"

#include <gtest/gtest.h>

#include <limits>

#include "normals/shapes.h"
#include "pcednet/spatial/curve_order.h"

namespace pcednet::normals {
namespace {

double share_opposed(const Shape& shape, const std::vector<Vec3>& normals) {
  const FlatPairs pairs(shape.positions, shape.normals, spatial::curve_order(shape.positions));
  EXPECT_GT(pairs.size(), 5 * std::min<std::size_t>(shape.positions.size(), 20000));
  return static_cast<double>(pairs.opposed(normals)) / static_cast<double>(pairs.size());
}

TEST(FlatPairs, AgreeOnCleanSurfacesAndAcrossThinWalls) {
  Shape plate = box(Vec3::Ones(), 40, 0.2);
  for (Vec3& p : plate.positions) p.z() *= 1.5 / 40;
  for (const Shape& shape : {sphere(30000, 1.0), box(Vec3::Ones(), 40, 0.4), plate}) {
    EXPECT_EQ(share_opposed(shape, shape.normals), 0.0);
    auto inward = shape.normals;
    for (Vec3& n : inward) n = -n;
    EXPECT_EQ(share_opposed(shape, inward), 0.0);
  }
}

TEST(FlatPairs, OpposeWhereSignsAreWrong) {
  const Shape shape = sphere(30000, 1.0);
  Random random(2);
  auto tenth = shape.normals, half = shape.normals, cap = shape.normals;
  for (std::size_t i = 0; i < shape.normals.size(); ++i) {
    if (random.uniform() < 0.1) tenth[i] = -tenth[i];
    if (random.uniform() < 0.5) half[i] = -half[i];
    if (shape.positions[i].x() > 0.5) cap[i] = -cap[i];
  }
  EXPECT_NEAR(share_opposed(shape, tenth), 2 * 0.1 * 0.9, 0.01);
  EXPECT_NEAR(share_opposed(shape, half), 0.5, 0.01);
  // The pairs across its border: a line of some 1 / sqrt(n) of the points.
  const double border = share_opposed(shape, cap);
  EXPECT_GT(border, 0.2 / std::sqrt(30000));
  EXPECT_LT(border, 3.0 / std::sqrt(30000));
}

TEST(FlatPairs, LeaveOutPointsWithoutNormalOrPlace) {
  Shape shape = sphere(1000, 1.0);
  constexpr double kNothing = std::numeric_limits<double>::quiet_NaN();
  for (std::size_t i = 0; i < 500; ++i) {
    shape.normals[i] = i % 2 ? Vec3(Vec3::Zero()) : Vec3(Vec3::Constant(kNothing));
  }
  shape.positions[700].x() = kNothing;
  const FlatPairs pairs(shape.positions, shape.normals, spatial::curve_order(shape.positions));
  EXPECT_GT(pairs.size(), 499u * 5);
  EXPECT_LE(pairs.size(), 499u * 12);
  EXPECT_EQ(FlatPairs({}, {}, {}).size(), 0u);
}

}  // namespace
}  // namespace pcednet::normals
