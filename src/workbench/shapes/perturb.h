#pragma once

#include <cstdint>

#include "pcednet/cloud/point_cloud.h"

namespace pcednet::shapes {

// What a cloud would be had it been acquired worse. What happens to a point depends on the seed and
// on where it is, not on how the points are numbered; points at exactly the same position share it.

struct NoiseOptions {
  double sigma = 0.004;       ///< standard deviation / diagonal of the bounding box, not negative
  bool along_normal = false;  ///< one deviate along the normal instead of one on each axis
  std::uint64_t seed = 1;
};

/// `cloud` with Gaussian noise on its positions, as in the paper's noisy ABC models (sigma 0.004,
/// along the normal). Everything else is kept, the clean normals among it; positions are rounded to
/// the cloud's position_type; a point that is not finite, or without the normal it needs, stays.
/// Throws Error(kUsage) for a sigma that is negative or not finite, Error(kInsufficient) if the
/// noise is to be along normals and there are none.
PointCloud add_gaussian_noise(PointCloud cloud, const NoiseOptions& options = {});

struct SubsampleOptions {
  double fraction = 0.5;  ///< of the points to keep, in [0, 1]
  std::uint64_t seed = 1;
};

/// round(fraction x points) points of `cloud` drawn at random, in their order, with all that
/// belongs to them. Of the foreign elements a LAS file's header and records stay; others (faces,
/// which would name points that are gone) are left out.
/// With the same seed a smaller fraction keeps a subset of what a larger one keeps. Throws
/// Error(kUsage) for a fraction outside [0, 1].
PointCloud subsample(const PointCloud& cloud, const SubsampleOptions& options = {});

}  // namespace pcednet::shapes
