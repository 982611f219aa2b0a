#include "pcednet/gls/projection.h"

#include <gtest/gtest.h>

#include "gls/test_clouds.h"
#include "pcednet/gls/sphere_fit.h"

namespace pcednet::gls {
namespace {

/// The sphere of that radius and centre scaled by `factor`, which must not matter.
AlgebraicSphere sphere(const Vec3& centre, double radius, double factor) {
  AlgebraicSphere u;
  u.uq = factor / (2 * radius);
  u.ul = -factor / radius * centre;
  u.uc = factor * (centre.squaredNorm() - radius * radius) / (2 * radius);
  u.pratt = std::abs(factor);
  return u;
}

TEST(Projection, ReachesTheNearestPointOfASphere) {
  test::Stream stream(1);
  for (int trial = 0; trial < 100; ++trial) {
    const Vec3 centre = 3 * stream.normal3();
    const double radius = 0.1 + 3 * stream.uniform(), factor = stream.normal();
    const Vec3 expected = centre - radius * centre.normalized();
    const Vec3 move = projection_move(sphere(centre, radius, factor));
    EXPECT_NEAR((move - expected).norm(), 0.0, 1e-13 * (1 + centre.squaredNorm() / radius));
  }
}

TEST(Projection, ReachesTheNearestPointOfAPlane) {
  AlgebraicSphere plane;
  plane.ul = Vec3(1, 2, -2) / 3;
  plane.uc = 0.7;
  EXPECT_NEAR((projection_move(plane) + 0.7 * plane.ul).norm(), 0.0, 1e-15);
  plane.ul *= 5, plane.uc *= 5, plane.pratt *= 5;
  EXPECT_NEAR((projection_move(plane) + 0.7 * plane.ul / 5).norm(), 0.0, 1e-15);
}

TEST(Projection, IsContinuousFromSpheresToPlanes) {
  const Vec3 normal = Vec3(1, 2, -2) / 3;
  for (const double radius : {1e3, 1e6, 1e9, 1e12}) {
    AlgebraicSphere flat;
    flat.uq = 1 / (2 * radius);
    flat.uc = 0.7;
    flat.ul = normal;
    flat.pratt = std::sqrt(1 - 4 * flat.uc * flat.uq);
    EXPECT_NEAR((projection_move(flat) + 0.7 * normal).norm(), 0.0, 2 / radius + 1e-15);
  }
}

TEST(Projection, KeepsTheDistanceOfThePointItself) {
  const AlgebraicSphere u = sphere({0, 0, -2}, 1.0, 1.0);
  EXPECT_NEAR(algebraic_distance(u, Vec3::Zero()), 1.5, 1e-15);
  EXPECT_NEAR(algebraic_distance(u, projection_move(u)), 0.0, 1e-15);
}

}  // namespace
}  // namespace pcednet::gls
