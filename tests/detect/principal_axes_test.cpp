#include "pcednet/detect/principal_axes.h"

#include <gtest/gtest.h>

#include <Eigen/Eigenvalues>
#include <Eigen/QR>
#include <cmath>
#include <vector>

#include "pcednet/core/random.h"

namespace pcednet::detect {
namespace {

/// Round, flat, long, diagonal and singular matrices of any size.
std::vector<Mat3> all_kinds() {
  Random random(7);
  std::vector<Mat3> all = {Mat3::Zero(), Mat3::Identity(), Mat3::Ones()};
  while (all.size() < 8000) {
    const Mat3 any = Mat3::NullaryExpr([&](auto, auto) { return random.normal(); });
    const Mat3 turned = any.householderQr().householderQ();
    const double flat = std::pow(10.0, -9.0 * random.uniform());
    const Mat3 product =
        turned * Vec3(flat, random.uniform(), 1.0).asDiagonal() * turned.transpose();
    Mat3 matrix = 0.5 * (product + product.transpose());
    switch (random.index(8)) {
      case 0:
        matrix(2, 0) = matrix(0, 2) = 0.0;
        break;
      case 1:
        matrix(1, 0) = matrix(0, 1) = 0.0;
        break;
      case 2:
        matrix(2, 1) = matrix(1, 2) = 1e-170;
        break;
      case 3:
        matrix *= 1e-300;
        break;
      case 4:
        matrix.diagonal().setConstant(matrix(0, 0));
        break;
      case 5:
        matrix = turned.col(0) * turned.col(0).transpose();
        break;
      default:
        break;
    }
    all.push_back(matrix);
  }
  return all;
}

TEST(PrincipalAxes, AreThoseOfEigenToTheLastBit) {
  const std::vector<Mat3> all = all_kinds();
  for (std::size_t first = 0; first < all.size(); first += SymmetricMatrices::kLanes) {
    SymmetricMatrices matrices;
    PrincipalAxes axes;
    for (std::size_t i = 0; i < SymmetricMatrices::kLanes; ++i) matrices.set(i, all[first + i]);
    find_principal_axes(matrices, axes);
    for (std::size_t i = 0; i < SymmetricMatrices::kLanes; ++i) {
      const Eigen::SelfAdjointEigenSolver<Mat3> expected(all[first + i]);
      ASSERT_EQ(axes.largest[i], expected.eigenvalues()[2]) << all[first + i];
      ASSERT_EQ(axes.middle[i], expected.eigenvalues()[1]) << all[first + i];
      ASSERT_EQ(Vec3(axes.axis[0][i], axes.axis[1][i], axes.axis[2][i]),
                Vec3(expected.eigenvectors().col(2)))
          << all[first + i];
    }
  }
}

}  // namespace
}  // namespace pcednet::detect
