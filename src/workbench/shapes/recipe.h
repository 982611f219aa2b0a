#pragma once

#include <cstddef>
#include <cstdint>
#include <string>

#include "pcednet/cloud/point_cloud.h"
#include "workbench/shapes/shape.h"

namespace pcednet::shapes {

struct GeneratedCloud {
  std::string name;
  PointCloud cloud;
};

enum class NormalSource {
  kSurface,   ///< the true ones
  kPlane10,   ///< of the plane through the 10 nearest points, as in the paper's clouds
  kEstimated  ///< by normals::estimate_normals
};

/// How a labelled cloud is made from a shape. Lengths are in spacings: sqrt(area / points).
struct Recipe {
  std::string name = {};
  Shape shape = {};
  std::size_t points = 10000;
  EdgeBands bands = {.sharp = 0.49, .smooth = 1.73};
  double noise = 0.0;         ///< standard deviation on each axis, every point
  double displacement = 0.0;  ///< reach of displace_every_tenth()
  double unevenness = 1.0;    ///< how many times denser the densest end is than the sparsest
  double min_distance = 0.0;  ///< between points, before noise
  NormalSource normals = NormalSource::kPlane10;
  bool inward = false;  ///< all normals into the solid
};

/// Draws the points, disturbs them, labels them by their distance to the true edges from where they
/// are then, gives them normals and turns the whole by a random rotation. Comments say how it was
/// made; positions are rounded to float.
///
/// Estimated normals have the side of the surface normal; of points displaced off the surface,
/// which has no bearing on them, one in four is turned about.
///
/// The result depends on the recipe and `seed` alone: two recipes of different name draw
/// independent points.
GeneratedCloud generate(const Recipe& recipe, std::uint64_t seed);

}  // namespace pcednet::shapes
