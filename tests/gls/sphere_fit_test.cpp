#include "pcednet/gls/sphere_fit.h"

#include <gtest/gtest.h>

#include <Eigen/Geometry>

#include "gls/neighbourhoods.h"
#include "pcednet/gls/covariance_plane.h"
#include "pcednet/gls/descriptor.h"

namespace pcednet::gls {
namespace {

SphereFit fit(const Neighbourhood& neighbours, double t) {
  const MomentSet moments = sum_moments(neighbours, t);
  return fit_sphere(moments.value, moments.count, t);
}

Descriptor describe(const Neighbourhood& neighbours, double t) {
  const MomentSet moments = sum_moments(neighbours, t);
  return describe_sphere(fit_sphere(moments.value, moments.count, t), moments);
}

TEST(SphereFit, RecoversAnExactSphereFromAnyPartOfIt) {
  test::Stream stream(1);
  for (int trial = 0; trial < 50; ++trial) {
    const Vec3 centre = stream.normal3();
    const double radius = 0.3 + stream.uniform(), side = trial % 2 ? 1.0 : -1.0;
    Neighbourhood neighbours;
    for (int i = 0; i < 4 + trial; ++i) {
      const Vec3 n = stream.direction();
      neighbours.push_back(test::neighbour(centre + radius * n, side * n));
    }
    const SphereFit found = fit(neighbours, 10.0);
    const AlgebraicSphere& u = found.sphere;
    // S = side (|y - centre|^2 - R^2) / 2R. Sums of some 10 terms of magnitude 1 to 10, divided by
    // a spread that may be a tenth: 1e-12.
    EXPECT_NEAR(u.uq, side / (2 * radius), 1e-12);
    EXPECT_NEAR((u.ul + side * centre / radius).norm(), 0.0, 1e-11);
    EXPECT_NEAR(u.uc, side * (centre.squaredNorm() - radius * radius) / (2 * radius), 1e-11);
    EXPECT_NEAR(u.pratt, 1.0, 1e-11);
    EXPECT_EQ(found.status, neighbours.size() < 6 ? FitStatus::kUnstable : FitStatus::kStable);
    const Descriptor d = describe(neighbours, 10.0);
    EXPECT_NEAR(d.phi, 0.0, 1e-11);
    EXPECT_NEAR(d.kappa, side / radius, 1e-11);
    // Where the point is near the centre eta turns fast: curvatures are those of its level set.
    EXPECT_NEAR(d.k1 * centre.norm(), side, 1e-9);
    EXPECT_NEAR(d.k2 * centre.norm(), side, 1e-9);
  }
}

TEST(SphereFit, RecoversAnExactPlaneWithoutCurvature) {
  test::Stream stream(2);
  const Vec3 normal = stream.direction();
  const Vec3 b1 = normal.unitOrthogonal(), b2 = normal.cross(b1);
  Neighbourhood neighbours;
  for (int i = 0; i < 30; ++i) {
    neighbours.push_back(test::neighbour(
        0.2 * normal + stream.normal() * 0.1 * b1 + stream.normal() * 0.1 * b2, normal));
  }
  const Descriptor d = describe(neighbours, 1.0);
  EXPECT_NEAR(d.tau, -0.2, 1e-14);
  EXPECT_NEAR((d.eta - normal).norm(), 0.0, 1e-14);
  // Rounding errors of 1e-16 over a spread of 0.01.
  for (const double zero : {d.kappa, d.phi, d.k1, d.k2, d.dtau_dt, d.dkappa_dt}) {
    EXPECT_NEAR(zero, 0.0, 1e-11);
  }
}

TEST(SphereFit, CountsThreeNeighboursAsUnstableAndSixAsStable) {
  test::Stream stream(5);
  const auto six = test::random_neighbourhood(stream, 6, 0.9, false);
  const FitStatus expected[] = {FitStatus::kUndefined, FitStatus::kUndefined, FitStatus::kUndefined,
                                FitStatus::kUnstable,  FitStatus::kUnstable,  FitStatus::kUnstable,
                                FitStatus::kStable};
  for (std::size_t count = 0; count <= 6; ++count) {
    const Neighbourhood some(six.begin(), six.begin() + static_cast<std::ptrdiff_t>(count));
    EXPECT_EQ(fit(some, 1.0).status, expected[count]) << count;
    EXPECT_EQ(fit_covariance_plane(some, 1.0).status, expected[count]) << count;
  }
}

/// Seven neighbours within `spread` of `place`, of two normals.
void expect_plane_limit(const Vec3& place, double spread) {
  test::Stream stream(6);
  Neighbourhood copies;
  for (int i = 0; i < 7; ++i) {
    copies.push_back(test::neighbour(place + spread * stream.direction(),
                                     i % 2 ? Vec3(1, 0, 0) : Vec3(0, 1, 0)));
  }
  const Descriptor d = describe(copies, 1.0);
  const Vec3 mean = Vec3(3, 4, 0) / 7;
  const double tolerance = 1e-14 + 10 * spread;
  EXPECT_EQ(fit(copies, 1.0).status, FitStatus::kStable);
  EXPECT_EQ(d.kappa, 0.0);
  EXPECT_NEAR((d.eta - mean.normalized()).norm(), 0.0, tolerance);
  EXPECT_NEAR(d.tau, -mean.normalized().dot(place), tolerance);
  EXPECT_NEAR(d.phi, 1 - mean.squaredNorm(), tolerance);
  // One tangent plane, whatever x and t.
  EXPECT_NEAR(d.k1, 0.0, tolerance);
  EXPECT_NEAR(d.dtau_dt, 0.0, tolerance);
  EXPECT_NEAR((d.dtau_dx - d.eta).norm(), 0.0, tolerance);
  EXPECT_EQ(d.dkappa_dt, 0.0);
}

TEST(SphereFit, TakesThePlaneLimitWhereNeighboursAreOnePlace) {
  for (const double spread : {0.0, 1e-8}) {
    expect_plane_limit({0, 0, 0}, spread);
    expect_plane_limit({0.1, 0.2, -0.3}, spread);
  }
}

TEST(SphereFit, IsUndefinedWhereNormalsCancel) {
  Neighbourhood wall;
  for (int i = 0; i < 8; ++i) {
    wall.push_back(test::neighbour(Vec3(0.1 * (i / 2), 0, 0), Vec3(0, 0, i % 2 ? 1 : -1)));
  }
  EXPECT_EQ(fit(wall, 1.0).status, FitStatus::kUndefined);
  const Descriptor d = describe(wall, 1.0);
  EXPECT_EQ(d.tau, 0.0);
  EXPECT_EQ(d.eta, Vec3::Zero());
}

TEST(SphereFit, IsUndefinedAtTheCentreOfASphere) {
  Neighbourhood sphere;
  for (int axis = 0; axis < 3; ++axis) {
    for (const double side : {-0.5, 0.5}) {
      sphere.push_back(test::neighbour(side * Vec3::Unit(axis), 2 * side * Vec3::Unit(axis)));
    }
  }
  EXPECT_EQ(fit(sphere, 1.0).status, FitStatus::kUndefined);
}

TEST(CovariancePlane, IsUndefinedForLinesSinglePlacesAndBalls) {
  Neighbourhood line, place, ball;
  for (int i = 0; i < 9; ++i) {
    line.push_back(test::neighbour(0.1 * (i - 4) * Vec3(1, 2, 3).normalized(), Vec3::UnitZ()));
    place.push_back(test::neighbour(Vec3(0.1, 0.2, 0.3), Vec3::UnitZ()));
  }
  for (int axis = 0; axis < 3; ++axis) {
    for (const double side : {-0.5, 0.5}) {
      ball.push_back(test::neighbour(side * Vec3::Unit(axis), Vec3::UnitZ()));
    }
  }
  EXPECT_EQ(fit_covariance_plane(line, 1.0).status, FitStatus::kUndefined);
  EXPECT_EQ(fit_covariance_plane(place, 1.0).status, FitStatus::kUndefined);
  EXPECT_EQ(fit_covariance_plane(ball, 1.0).status, FitStatus::kUndefined);
}

}  // namespace
}  // namespace pcednet::gls
