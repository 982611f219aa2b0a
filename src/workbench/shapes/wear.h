#pragma once

#include <span>

#include "pcednet/cloud/point_cloud.h"
#include "pcednet/core/random.h"
#include "workbench/shapes/solids/mesh_vertices.h"
#include "workbench/shapes/surfaces/sampling.h"
#include "workbench/shapes/surfaces/shape.h"

namespace pcednet::shapes {

/// The bands of worn edges, in spacings: the smooth-edge band is as wide beside that of sharp-edge
/// as beside an edge that is not worn.
inline EdgeBands worn_bands(double sharp) {
  return {.sharp = sharp, .smooth = sharp + 1.24};
}

/// The wear of a surface; all values are lengths.
struct Wear {
  double rounding = 0.0;  ///< standard deviation of the Gaussian that smooths the surface
  EdgeBands bands = {};   ///< widths of the labelled bands
  double scatter = 0.0;   ///< standard deviation of noise on each axis
  double waves = 0.0;     ///< height of shallow waves
};

/// Labels vertices by their distance to the original edges, then smooths the surface: every vertex
/// and its normal become the Gaussian mean of the surface around it. Then adds shallow waves.
void wear_off(MeshVertices& vertices, const SurfaceSamples& surface, std::span<const Vec3> edges,
              const Wear& wear, Random& random);

struct Finish {
  bool estimated = false;  ///< normals from the positions
  bool inward = false;     ///< all normals flipped
};

Mat3 gaussian_rotation(Random& random);

/// The vertices as a cloud, rotated, in single precision.
PointCloud finish(MeshVertices vertices, const Finish& finish, const Mat3& rotation);

}  // namespace pcednet::shapes
