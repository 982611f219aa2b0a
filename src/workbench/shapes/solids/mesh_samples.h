#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <span>

#include "pcednet/cloud/point_cloud.h"
#include "pcednet/core/progress.h"

namespace pcednet::shapes {

struct MeshSampleOptions {
  std::size_t points = 100000;
  bool vertex_normals = false;  ///< interpolate vertex normals instead of using face normals
  std::uint64_t seed = 1;
};

/// Points sampled uniformly by area on the triangles, whose corners are indices of `vertices`, with
/// unit normals (a face normal points to the side from which its corners run counter-clockwise)
/// and, if the vertices have them, interpolated colours. Comments are kept, attributes are not.
/// Throws Error(kInsufficient) if the triangles have no area, or if vertex normals are requested
/// and missing.
PointCloud sample_mesh(const PointCloud& vertices,
                       std::span<const std::array<std::uint32_t, 3>> triangles,
                       const MeshSampleOptions& options = {}, const Progress* progress = nullptr);

}  // namespace pcednet::shapes
