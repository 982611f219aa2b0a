#pragma once

#include <cstddef>
#include <functional>
#include <vector>

#include "pcednet/core/random.h"
#include "workbench/shapes/shape.h"

namespace pcednet::shapes {

struct SampleOptions {
  std::size_t points = 10000;
  /// The probability that a point at this position is kept; empty: 1 everywhere.
  std::function<double(const Vec3& position)> keep = {};
  /// If positive, points closer than this to an earlier point are dropped (Poisson disc sampling).
  /// Must be below 0.75 sqrt(area / points), or there is no room for all points.
  double min_distance = 0.0;
};

struct SurfaceSamples {
  std::vector<Vec3> positions;
  std::vector<Vec3> normals;  ///< of the surface, unit
};

/// Points sampled uniformly by area. Throws Error(kFailure) if a density exceeds the patch's
/// max_density, or if there is no room for the points.
SurfaceSamples sample_surface(const Shape& shape, const SampleOptions& options, Random& random);

}  // namespace pcednet::shapes
