#pragma once

#include "pcednet/core/vec3.h"

namespace pcednet {

/// The eigenvalues of a symmetric matrix, ascending, and its unit eigenvectors as columns.
struct Eigendecomposition {
  Vec3 values;
  Mat3 vectors;
};

/// By the closed form, which is fast and accurate to about 1e-8 of the largest eigenvalue; reads
/// the lower half of the matrix.
Eigendecomposition eigendecomposition(const Mat3& symmetric);

/// The unit eigenvector of the least eigenvalue, and the two least eigenvalues.
struct LeastAxis {
  Vec3 axis;
  double value, next_value;
};

/// Of a symmetric matrix without negative eigenvalues, as accurate, in a third of the time and with
/// the same bytes on every processor; reads the lower half of the matrix.
LeastAxis least_axis(const Mat3& symmetric);

}  // namespace pcednet
