#include "pcednet/gls/descriptor.h"

#include <gtest/gtest.h>

#include <Eigen/Eigenvalues>
#include <functional>
#include <numbers>

#include "gls/neighbourhoods.h"
#include "pcednet/gls/covariance_plane.h"
#include "pcednet/gls/features.h"

namespace pcednet::gls {
namespace {

using Describe = std::function<Descriptor(const Neighbourhood&, double t)>;

Descriptor of_sphere(const Neighbourhood& neighbours, double t) {
  const MomentSet moments = sum_moments(neighbours, t);
  return describe_sphere(fit_sphere(moments.value, moments.count, t), moments);
}

Descriptor of_plane(const Neighbourhood& neighbours, double t) {
  return fit_covariance_plane(neighbours, t).descriptor;
}

/// tau, eta, kappa.
using Parameters = Eigen::Matrix<double, 5, 1>;

Parameters parameters(const Descriptor& d) {
  Parameters p;
  p << d.tau, d.eta, d.kappa;
  return p;
}

/// f'(0) by central differences, extrapolated: the error is of order h^4.
Parameters derivative(const std::function<Parameters(double)>& f, double h) {
  const auto slope = [&](double step) { return Parameters((f(step) - f(-step)) / (2 * step)); };
  return (4 * slope(h) - slope(2 * h)) / 3;
}

void expect_close(const Parameters& expected, const Parameters& actual) {
  // The step of 2e-4 leaves 1e-15 times a fifth derivative, which six points in a poor position
  // take to 1e6, and rounding errors over the step, 1e-11: so 1e-8.
  for (int i = 0; i < 5; ++i) {
    EXPECT_NEAR(expected[i], actual[i], 1e-8 * std::max(1.0, std::abs(expected[i]))) << i;
  }
}

/// Every entry of the Jacobian of `describe` against finite differences, in which the neighbours
/// really are seen from another place and weighted by another kernel.
void check_jacobian(const Describe& describe, bool gated) {
  test::Stream stream(11);
  for (int trial = 0; trial < 20; ++trial) {
    const double t = 1.0;
    const auto neighbours = test::random_neighbourhood(stream, 6 + 3 * trial, 0.99 * t, gated);
    const Descriptor d = describe(neighbours, t);
    Parameters dt;
    dt << d.dtau_dt, d.deta_dt, d.dkappa_dt;
    expect_close(
        derivative(
            [&](double h) {
              return parameters(describe(test::seen_from(neighbours, Vec3::Zero(), t + h), t + h));
            },
            2e-4),
        dt);
    for (int k = 0; k < 3; ++k) {
      Parameters dx;
      dx << d.dtau_dx[k], d.deta_dx.col(k), d.dkappa_dx[k];
      expect_close(
          derivative(
              [&](double h) {
                return parameters(describe(test::seen_from(neighbours, h * Vec3::Unit(k), t), t));
              },
              2e-4),
          dx);
    }
  }
}

TEST(Descriptor, JacobianOfTheSphereEqualsFiniteDifferences) {
  check_jacobian(of_sphere, false);
}
TEST(Descriptor, JacobianOfTheGatedSphereEqualsFiniteDifferences) {
  check_jacobian(of_sphere, true);
}
TEST(Descriptor, JacobianOfThePlaneEqualsFiniteDifferences) {
  check_jacobian(of_plane, false);
}
TEST(Descriptor, JacobianOfTheGatedPlaneEqualsFiniteDifferences) {
  check_jacobian(of_plane, true);
}

TEST(Descriptor, PrincipalCurvaturesAreEigenvaluesInTheTangentPlane) {
  test::Stream stream(3);
  for (int trial = 0; trial < 200; ++trial) {
    Vec3 eta = stream.direction();
    if (trial % 4 == 0) eta = Vec3::Unit(trial / 4 % 3) * (trial % 8 ? 1.0 : -1.0);
    Mat3 jacobian;
    for (int k = 0; k < 3; ++k) jacobian.col(k) = stream.normal3();
    const auto [k1, k2] = principal_curvatures(jacobian, eta, 1.0);
    const Mat3 tangent = Mat3::Identity() - eta * eta.transpose();
    const Mat3 form = tangent * 0.5 * (jacobian + jacobian.transpose()) * tangent;
    // The third eigenvalue is 0, for eta; moved out of the way.
    const Vec3 values =
        Eigen::SelfAdjointEigenSolver<Mat3>(form + 1e3 * eta * eta.transpose()).eigenvalues();
    EXPECT_GE(std::abs(k1), std::abs(k2));
    EXPECT_NEAR(std::min(k1, k2), values[0], 1e-11);
    EXPECT_NEAR(std::max(k1, k2), values[1], 1e-11);
    const auto [m1, m2] = principal_curvatures(-jacobian, -eta, -1.0);
    EXPECT_EQ(m1, -k1);
    EXPECT_EQ(m2, -k2);
  }
}

TEST(Descriptor, PrincipalCurvaturesOfEqualMagnitudeTakeTheSignOfTheTie) {
  Mat3 saddle = Mat3::Zero();
  saddle(0, 0) = 2, saddle(1, 1) = -2;
  EXPECT_EQ(principal_curvatures(saddle, Vec3::UnitZ(), 0.5).k1, 2.0);
  EXPECT_EQ(principal_curvatures(saddle, Vec3::UnitZ(), 0.0).k1, 2.0);
  EXPECT_EQ(principal_curvatures(-saddle, -Vec3::UnitZ(), -0.5).k1, -2.0);
  const auto [k1, k2] = principal_curvatures(Mat3::Zero(), Vec3::UnitX(), 0.0);
  EXPECT_EQ(k1, 0.0);
  EXPECT_EQ(k2, 0.0);
}

/// The features of kPaper6 at the support radius 1.
std::array<double, 6> features_of(const Neighbourhood& neighbours) {
  std::array<double, 6> features;
  write_features(FeatureSet::kPaper6, of_sphere(neighbours, 1.0), 1.0, features);
  return features;
}

TEST(Descriptor, OfAStraightEdgeEqualsTheIntegrals) {
  // Two half planes at a right angle, seen from their edge. With p = 48/(105 pi) the mean of each
  // coordinate over both and 1/4 the mean of |y|^2 (integrals of the kernel over half a disc), the
  // formulas of the fit give, with A = p and B = 1/4 - 2 p^2,
  Neighbourhood edge;
  test::for_grid([&](double a, double b) {
    if (a > 0) edge.push_back(test::neighbour({0, -a, b}, Vec3::UnitX()));
    if (a > 0) edge.push_back(test::neighbour({-a, 0, b}, Vec3::UnitY()));
  });
  const double p = 48 / (105 * std::numbers::pi);
  const double uq = p / (2 * (0.25 - 2 * p * p));
  const double ul = 0.5 + 2 * uq * p;  // both coordinates
  const double uc = 2 * ul * p - uq * 0.25;
  const double pratt = std::sqrt(2 * ul * ul - 4 * uc * uq);
  const auto [tau, kappa, k1, dtau, dkappa, phi] = features_of(edge);
  // The grid has 100 cells to the radius; the kernel and its slope vanish at the rim, so the sums
  // are off by less than 1e-4 even where the half planes end.
  EXPECT_NEAR(phi, 1 - pratt * pratt, 1e-4);
  EXPECT_NEAR(tau, uc / pratt, 1e-4);
  EXPECT_NEAR(kappa, 2 * uq / pratt, 1e-3);
  // An edge looks the same at every scale: tau ~ t and kappa ~ 1/t.
  EXPECT_NEAR(dtau, tau, 1e-3);
  EXPECT_NEAR(dkappa, -kappa, 1e-2);
  EXPECT_GT(k1, 1.0);
  EXPECT_NEAR(phi, 0.398, 1e-3);
}

TEST(Descriptor, OfACylinderHasItsCurvaturesAndResidual) {
  const double radius = 20.0;  // of the support radius 1
  Neighbourhood cylinder;
  test::for_grid([&](double a, double b) {
    const double angle = a / radius;
    const Vec3 n(std::sin(angle), 0, std::cos(angle));
    const Vec3 y = radius * (n - Vec3::UnitZ()) + b * Vec3::UnitY();
    if (y.norm() < 1.0) cylinder.push_back(test::neighbour(y, n));
  });
  const Descriptor d = of_sphere(cylinder, 1.0);
  // To leading order in 1/radius; the next is (1/radius)^2 = 0.25 % smaller, the grid adds 0.1 %.
  EXPECT_NEAR(d.kappa * radius, 0.5, 0.5 * 4e-3);
  EXPECT_NEAR(d.k1 * radius, 1.0, 4e-3);
  EXPECT_NEAR(d.k2 * radius, 0.0, 4e-3);
  // Half the normals' turning is left over: phi = <|y|^2> / (4 R^2) with <|y|^2> = 1/4.
  EXPECT_NEAR(d.phi * 16 * radius * radius, 1.0, 1e-2);
  EXPECT_NEAR(d.eta.dot(Vec3::UnitZ()), 1.0, 1e-12);
}

TEST(Descriptor, OfTheCovariancePlaneOfAnEdgeIsTheDiagonalPlane) {
  Neighbourhood edge;
  test::for_grid([&](double a, double b) {
    if (a > 0) edge.push_back(test::neighbour({0, -a, b}, Vec3::UnitX()));
    if (a > 0) edge.push_back(test::neighbour({-a, 0, b}, Vec3::UnitY()));
  });
  const Descriptor d = of_plane(edge, 1.0);
  const double p = 48 / (105 * std::numbers::pi);
  EXPECT_NEAR((d.eta - Vec3(1, 1, 0).normalized()).norm(), 0.0, 1e-12);
  EXPECT_NEAR(d.tau, std::sqrt(2.0) * p, 1e-4);
  // Along the edge the variance is 1/8 = <|y|^2>/2; across it 1/16 in each coordinate, of which
  // the diagonal away from the edge loses its mean: lambda = 1/16 - p^2 and 1/16 - p^2 +-
  // (covariance of the two coordinates, 0 - p^2).
  const double low = 1.0 / 16 - p * p - p * p, high = 1.0 / 16;
  EXPECT_NEAR(d.phi, 3 * low / (low + high + 1.0 / 8), 1e-3);
  EXPECT_EQ(d.kappa, 0.0);
  EXPECT_NEAR(d.dtau_dt, d.tau, 1e-3);
}

}  // namespace
}  // namespace pcednet::gls
