#pragma once

#include <cstddef>

#include "pcednet/core/vec3.h"

namespace pcednet::detect {

/// A fixed number of symmetric 3x3 matrices side by side. All entries must be finite.
struct SymmetricMatrices {
  static constexpr std::size_t kLanes = 8;
  alignas(64) double xx[kLanes], yx[kLanes], zx[kLanes], yy[kLanes], zy[kLanes], zz[kLanes];

  void set(std::size_t lane, const Mat3& m) {
    xx[lane] = m(0, 0), yx[lane] = m(1, 0), zx[lane] = m(2, 0);
    yy[lane] = m(1, 1), zy[lane] = m(2, 1), zz[lane] = m(2, 2);
  }
};

/// Their largest and middle eigenvalues, and the unit eigenvector of the largest.
struct PrincipalAxes {
  alignas(64) double largest[SymmetricMatrices::kLanes], middle[SymmetricMatrices::kLanes];
  double axis[3][SymmetricMatrices::kLanes];
};

/// Computes them by the QR algorithm, all at once, with the steps, and hence the bytes, of Eigen's
/// SelfAdjointEigenSolver::compute().
void find_principal_axes(const SymmetricMatrices& matrices, PrincipalAxes& axes);

}  // namespace pcednet::detect
