#include "pcednet/core/eigendecomposition.h"

#include <gtest/gtest.h>

#include <cmath>

#include "pcednet/core/random.h"

namespace pcednet {
namespace {

TEST(Eigendecomposition, GivesTheMatrixBack) {
  Random random(3);
  for (int trial = 0; trial < 50; ++trial) {
    Mat3 rows;
    for (int i = 0; i < 9; ++i) rows(i / 3, i % 3) = random.normal();
    const Mat3 matrix = rows * rows.transpose();
    const auto [values, vectors] = eigendecomposition(matrix);
    EXPECT_LE(values[0], values[1]);
    EXPECT_LE(values[1], values[2]);
    EXPECT_LT((vectors.transpose() * vectors - Mat3::Identity()).norm(), 1e-6);
    const Mat3 again = vectors * values.asDiagonal() * vectors.transpose();
    EXPECT_LT((again - matrix).norm(), 1e-6 * values[2]);
  }
}

TEST(Eigendecomposition, OfEqualEigenvaluesHasOrthogonalVectors) {
  const auto [values, vectors] = eigendecomposition(2.0 * Mat3::Identity());
  EXPECT_LT((values - Vec3::Constant(2.0)).norm(), 1e-12);
  EXPECT_LT((vectors.transpose() * vectors - Mat3::Identity()).norm(), 1e-12);
}

TEST(Eigendecomposition, OfPointsOnALineHasOneDirection) {
  const Vec3 along = Vec3(1, 2, 2) / 3.0;
  const auto [values, vectors] = eigendecomposition(9.0 * along * along.transpose());
  EXPECT_NEAR(values[2], 9.0, 1e-12);
  EXPECT_NEAR(values[1], 0.0, 1e-7);
  EXPECT_NEAR(std::abs(vectors.col(2).dot(along)), 1.0, 1e-12);
}

}  // namespace
}  // namespace pcednet
