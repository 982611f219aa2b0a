#pragma once

#include "pcednet/core/vec3.h"

namespace pcednet {

/// Of a symmetric matrix: its eigenvalues, ascending, and unit eigenvectors, the columns.
struct Eigendecomposition {
  Vec3 values;
  Mat3 vectors;
};

/// By the closed form, which is quick and right to about 1e-8 of the largest eigenvalue; of the
/// matrix, its lower half is read.
Eigendecomposition eigendecomposition(const Mat3& symmetric);

}  // namespace pcednet
