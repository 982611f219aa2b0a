#pragma once

#include <cstddef>
#include <functional>
#include <span>
#include <vector>

#include "pcednet/core/random.h"
#include "pcednet/core/vec3.h"
#include "workbench/shapes/surfaces/shape.h"

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

// Faults of acquisition.

/// Moves every position by a normal deviate of standard deviation `sigma` on each axis.
void add_noise(std::span<Vec3> positions, double sigma, Random& random);

/// Moves every tenth position by d (1, 1, 1), d uniform in [0, reach): the noise of the paper's
/// evaluation clouds, which leaves the other points exactly on the surface. Returns the indices of
/// the moved points.
std::vector<std::size_t> displace_every_tenth(std::span<Vec3> positions, double reach,
                                              Random& random);

/// The unit normals, of any sign, of the planes fitted by least squares to the `neighbours` points
/// nearest to each position, including itself. These are exactly the normals of the paper's
/// evaluation clouds; normals::estimate_normals is the better estimate.
std::vector<Vec3> plane_normals(std::span<const Vec3> positions, std::size_t neighbours = 10);

/// Estimated normals as programs write them to files: of planes through one number of neighbours,
/// that which suits most points, and of consistent sign.
std::vector<Vec3> oriented_normals(std::span<const Vec3> positions);

/// The spacing of the points around each position: that of the regular grid whose ten nearest
/// neighbours are as far away in the mean.
std::vector<double> local_spacings(std::span<const Vec3> positions);

}  // namespace pcednet::shapes
