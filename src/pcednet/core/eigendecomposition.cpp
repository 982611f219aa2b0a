#include "pcednet/core/eigendecomposition.h"

#include <Eigen/Eigenvalues>

namespace pcednet {

Eigendecomposition eigendecomposition(const Mat3& symmetric) {
  Eigen::SelfAdjointEigenSolver<Mat3> solver;
  solver.computeDirect(symmetric);
  return {solver.eigenvalues(), solver.eigenvectors()};
}

}  // namespace pcednet
