#include "pcednet/core/eigendecomposition.h"

#include <Eigen/Eigenvalues>
#include <algorithm>
#include <cmath>

namespace pcednet {

Eigendecomposition eigendecomposition(const Mat3& symmetric) {
  Eigen::SelfAdjointEigenSolver<Mat3> solver;
  solver.computeDirect(symmetric);
  return {solver.eigenvalues(), solver.eigenvectors()};
}

LeastAxis least_axis(const Mat3& symmetric) {
  const double trace = symmetric.trace(), scale = 1.0 / trace;
  const double a = symmetric(0, 0) * scale, b = symmetric(1, 0) * scale;
  const double c = symmetric(1, 1) * scale, d = symmetric(2, 0) * scale;
  const double e = symmetric(2, 1) * scale, f = symmetric(2, 2) * scale;
  // Newton's method on the characteristic polynomial x^3 - x^2 + minors x - determinant, which is
  // concave below its least root, comes to that from below.
  const double minors = (a * c - b * b) + (a * f - d * d) + (c * f - e * e);
  const double determinant = a * (c * f - e * e) - b * (b * f - e * d) + d * (b * e - c * d);
  constexpr int kMostSteps = 12;
  constexpr double kSmallStep = 1e-9;  // the error that it leaves is about its square
  double least = 0.0;
  for (int i = 0; i < kMostSteps; ++i) {
    const double value = ((least - 1.0) * least + minors) * least - determinant;
    const double slope = (3.0 * least - 2.0) * least + minors;
    const double step = -value / slope;
    if (!(step > 0.0)) break;
    least += step;
    if (step < kSmallStep) break;
  }
  // The columns of the adjugate of the matrix less its least eigenvalue are along the axis.
  const double a1 = a - least, c1 = c - least, f1 = f - least;
  const double diagonal[3] = {c1 * f1 - e * e, a1 * f1 - d * d, a1 * c1 - b * b};
  const double xy = e * d - b * f1, xz = b * e - c1 * d, yz = b * d - a1 * e;
  const Vec3 columns[3] = {{diagonal[0], xy, xz}, {xy, diagonal[1], yz}, {xz, yz, diagonal[2]}};
  const auto largest = std::max_element(diagonal, diagonal + 3) - diagonal;
  constexpr double kLeastGap = 1e-10;  // between the eigenvalues
  if (!(diagonal[largest] > kLeastGap)) {
    const auto [values, vectors] = eigendecomposition(symmetric);
    return {vectors.col(0), values[0], values[1]};
  }
  const double half = 0.5 * (1.0 - least), product = minors - 2.0 * least * half;
  const double next = half - std::sqrt(std::max(half * half - product, 0.0));
  return {columns[largest].normalized(), trace * least, trace * next};
}

}  // namespace pcednet
