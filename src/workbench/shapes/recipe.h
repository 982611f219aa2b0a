#pragma once

#include <cstddef>
#include <cstdint>
#include <string>
#include <vector>

#include "pcednet/cloud/point_cloud.h"
#include "pcednet/lines/curves/curve.h"
#include "workbench/shapes/surfaces/shape.h"

namespace pcednet::shapes {

struct GeneratedCloud {
  std::string name;
  PointCloud cloud;
  std::vector<lines::Curve> curves = {};  ///< the true edges, in the cloud's coordinates
};

enum class NormalSource {
  kSurface,   ///< the true ones
  kPlane10,   ///< of the plane through the 10 nearest points, as in the paper's clouds
  kEstimated  ///< by normals::estimate_normals with one number of neighbours
};

/// How a labelled cloud is made from a shape. Lengths are in spacings: sqrt(area / points).
struct Recipe {
  std::string name = {};
  Shape shape = {};
  std::size_t points = 10000;
  EdgeBands bands = {.sharp = 0.49, .smooth = 1.73};
  double noise = 0.0;         ///< standard deviation on each axis, every point
  double displacement = 0.0;  ///< `reach` of displace_every_tenth()
  double unevenness = 1.0;    ///< density at the densest end over that at the sparsest
  double min_distance = 0.0;  ///< between points, before noise
  NormalSource normals = NormalSource::kPlane10;
  bool inward = false;      ///< all normals point into the solid
  std::size_t thinned = 1;  ///< one point in this many is kept at the end, at random
};

/// Samples the points, disturbs them, labels them by the distance of the disturbed points to the
/// true edges, adds normals and applies a random rotation. Comments state the recipe; positions are
/// rounded to float.
///
/// Estimated normals point to the side of the surface normal; one in four normals of displaced
/// points is flipped.
///
/// The result depends on the recipe and `seed` alone: two recipes of different name draw
/// independent points.
GeneratedCloud generate(const Recipe& recipe, std::uint64_t seed);

}  // namespace pcednet::shapes
