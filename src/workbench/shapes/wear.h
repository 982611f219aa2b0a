#pragma once

#include <span>

#include "pcednet/cloud/point_cloud.h"
#include "pcednet/core/random.h"
#include "workbench/shapes/mesh_vertices.h"
#include "workbench/shapes/sampling.h"

namespace pcednet::shapes {

/// How worn a surface is, all lengths.
struct Wear {
  double rounding = 0.0;  ///< standard deviation of the Gaussian that the surface is averaged with
  double band = 0.0;      ///< points this near an edge are sharp-edge
  double scatter = 0.0;   ///< standard deviation of noise on each axis
  double waves = 0.0;     ///< height of shallow waves
};

/// Labels vertices by the distance to the edges as they were, then rounds these off: every vertex
/// and its normal become the Gaussian mean of the surface around, which then gets shallow waves.
void wear_off(MeshVertices& vertices, const SurfaceSamples& surface, std::span<const Vec3> edges,
              const Wear& wear, Random& random);

struct Finish {
  bool estimated = false;  ///< normals from the positions
  bool inward = false;     ///< all normals turned
};

/// The vertices as a cloud, turned at random, in single precision.
PointCloud finish(MeshVertices vertices, const Finish& finish, Random& random);

}  // namespace pcednet::shapes
