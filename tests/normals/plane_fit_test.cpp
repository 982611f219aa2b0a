#include "pcednet/normals/plane_fit.h"

#include <gtest/gtest.h>

#include <Eigen/Eigenvalues>
#include <Eigen/QR>
#include <algorithm>
#include <numeric>
#include <vector>

#include "pcednet/core/random_vectors.h"

namespace pcednet::normals {
namespace {

/// The plane by its definition at estimate_normals(), with an iterative solver.
PlaneFit plane_of(const std::vector<Vec3>& points, std::uint32_t point,
                  std::span<const std::uint32_t> neighbours) {
  const double sq_h = 1.05 * (points[neighbours.back()] - points[point]).squaredNorm();
  std::vector<std::pair<Vec3, double>> weighted = {{points[point], 1.0}};
  for (const std::uint32_t j : neighbours) {
    const double falloff = 1.0 - (points[j] - points[point]).squaredNorm() / sq_h;
    weighted.emplace_back(points[j], falloff * falloff);
  }
  double sum = 0.0;
  Vec3 mean = Vec3::Zero();
  for (const auto& [y, w] : weighted) sum += w, mean += w * y;
  mean /= sum;
  Mat3 c = Mat3::Zero();
  for (const auto& [y, w] : weighted) c += w * (y - mean) * (y - mean).transpose();
  const Eigen::SelfAdjointEigenSolver<Mat3> axes(c);
  return {axes.eigenvectors().col(0), axes.eigenvalues()[0] / axes.eigenvalues()[1]};
}

/// Neighbourhoods as flat, round or long as `sides`, turned anywhere; each in a place of its own.
struct Neighbourhoods {
  Neighbourhoods(std::size_t count, std::size_t degree, const Vec3& sides) {
    Random random(4);
    for (std::size_t i = 0; i < count; ++i) {
      const Mat3 any = Mat3::NullaryExpr([&](auto, auto) { return random.normal(); });
      const Mat3 turned = any.householderQr().householderQ();
      some.push_back(static_cast<std::uint32_t>(points.size()));
      for (std::size_t k = 0; k <= degree; ++k) {
        const Vec3 p = normal_vector(random);
        if (k > 0) neighbours.push_back(static_cast<std::uint32_t>(points.size()));
        points.push_back(turned * sides.cwiseProduct(p) + Vec3::Constant(static_cast<double>(i)));
      }
      const auto row = neighbours.end() - static_cast<std::ptrdiff_t>(degree);
      std::sort(row, neighbours.end(), [&](std::uint32_t a, std::uint32_t b) {
        return (points[a] - points[some.back()]).norm() < (points[b] - points[some.back()]).norm();
      });
    }
    fits.resize(count);
    fit_planes(points, some, neighbours, fits);
  }

  std::vector<Vec3> points;
  std::vector<std::uint32_t> some, neighbours;
  std::vector<PlaneFit> fits;
};

TEST(PlaneFit, IsThatOfItsDefinition) {
  for (const std::size_t degree : {3, 12, 48}) {
    for (const Vec3& sides :
         {Vec3(1, 1, 1e-6), Vec3(1, 1, 0.1), Vec3(1, 0.2, 0.01), Vec3(1, 1, 1)}) {
      const Neighbourhoods all(21, degree, sides);  // no multiple of the lanes
      for (std::size_t i = 0; i < all.fits.size(); ++i) {
        const PlaneFit expected = plane_of(all.points, all.some[i],
                                           std::span(all.neighbours).subspan(i * degree, degree));
        const PlaneFit& fit = all.fits[i];
        // The closed form is good to 1e-8 of the largest eigenvalue.
        EXPECT_NEAR(fit.thickness, expected.thickness, 1e-5);
        if (expected.thickness < 0.9) {
          EXPECT_GT(std::abs(fit.normal.dot(expected.normal)), 1.0 - 1e-6);
        }
        EXPECT_NEAR(fit.normal.norm(), 1.0, 1e-15);
      }
    }
  }
}

TEST(PlaneFit, HasNoPlaneThroughALine) {
  const Neighbourhoods line(9, 12, Vec3(1, 0, 0));
  for (const PlaneFit& fit : line.fits) EXPECT_EQ(fit.normal, Vec3(0, 0, 0));
  std::vector<PlaneFit> fits(1, {Vec3::Ones(), 1.0});
  fit_planes(line.points, std::vector<std::uint32_t>{0}, std::vector<std::uint32_t>{1}, fits);
  EXPECT_EQ(fits[0].normal, Vec3(0, 0, 0));
}

TEST(PlaneFit, OfACubesCornersIsDefined) {  // all three eigenvalues are equal
  std::vector<Vec3> points = {Vec3::Zero()};
  for (int k = 0; k < 8; ++k) points.emplace_back(k & 1 ? 1 : -1, k & 2 ? 1 : -1, k & 4 ? 1 : -1);
  std::vector<std::uint32_t> corners(8);
  std::iota(corners.begin(), corners.end(), 1u);
  std::vector<PlaneFit> fits(1);
  fit_planes(points, std::vector<std::uint32_t>{0}, corners, fits);
  EXPECT_EQ(fits[0].normal, Vec3(1, 0, 0));
  EXPECT_EQ(fits[0].thickness, 1.0);
}

}  // namespace
}  // namespace pcednet::normals
