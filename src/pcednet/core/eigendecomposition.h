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

}  // namespace pcednet
