#pragma once

#include <cstdint>
#include <span>

#include "pcednet/cloud/point_cloud.h"
#include "pcednet/core/progress.h"

namespace pcednet::shapes {

// Noise, subsampling and thinning of a cloud. The change of a point depends on the seed and its
// position, not on the numbering; points at exactly the same position change in the same way.

struct NoiseOptions {
  double sigma = 0.004;       ///< standard deviation / diagonal of the bounding box, not negative
  bool along_normal = false;  ///< one deviate along the normal instead of one on each axis
  std::uint64_t seed = 1;
};

/// `cloud` with Gaussian noise on its positions, as in the paper's noisy ABC models (sigma 0.004,
/// along the normal). All else is kept, including the clean normals; positions are rounded to
/// the cloud's position_type; a point that is not finite, or without the normal it needs, stays.
/// Throws Error(kUsage) for a sigma that is negative or not finite, Error(kInsufficient) if the
/// noise is to be along normals and there are none.
PointCloud add_gaussian_noise(PointCloud cloud, const NoiseOptions& options = {});

/// These points of `cloud`, by their numbers, with all their fields. The header and records of LAS
/// stay; other foreign elements (faces, which would name removed points) are left out.
PointCloud select(const PointCloud& cloud, std::span<const std::uint32_t> points);

struct SubsampleOptions {
  double fraction = 0.5;  ///< of the points to keep, in [0, 1]
  std::uint64_t seed = 1;
};

/// round(fraction x points) random points of `cloud`, in their order, with what select() keeps.
/// With the same seed a smaller fraction keeps a subset of the points of a larger one. Throws
/// Error(kUsage) for a fraction outside [0, 1].
PointCloud subsample(const PointCloud& cloud, const SubsampleOptions& options = {});

struct ThinOptions {
  double spacing = 0.0;  ///< in the unit of the cloud, positive
  std::uint64_t seed = 1;
};

/// Points of `cloud`, tried in random order, that are `spacing` or more apart, so that each point
/// left out is nearer to one of them; in their order, with what select() keeps. Points that are
/// not finite are left out. Throws Error(kUsage) for a spacing that is not positive or not finite,
/// Error(kCancelled) when `progress` asks to cancel.
PointCloud thin(const PointCloud& cloud, const ThinOptions& options,
                const Progress* progress = nullptr);

}  // namespace pcednet::shapes
