#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "pcednet/core/progress.h"
#include "pcednet/core/vec3.h"
#include "pcednet/gls/engine/voxels.h"
#include "pcednet/gls/neighbourhood.h"
#include "pcednet/gls/pyramid_plan.h"
#include "pcednet/spatial/box_tree.h"

namespace pcednet::gls {

/// The cloud at one resolution, along a space-filling curve.
struct VoxelLevel {
  double cell = 0.0;     ///< edge of the cells that were merged; 0 for the points themselves
  float most_qq = 0.0f;  ///< the largest qq of its voxels
  VoxelArray voxels;
  spatial::BoxTree boxes;
};

/// The cloud at falling resolutions; the same for any numbering of the points, and under a flip of
/// all normals the same but for the sign of every mean normal and qn.
struct VoxelPyramid {
  Vec3 origin = Vec3::Zero();         ///< the lower corner of the box of the cloud, or of the whole
  double side = 0.0;                  ///< its longest side
  std::vector<VoxelLevel> levels;     ///< from fine to coarse; the first holds the points
  std::vector<std::size_t> level_of;  ///< the level that serves each scale
  std::vector<PyramidPlan::Level> plan;  ///< how each scale got its level
};

/// The first level: the points numbered `order`, which must be finite, each as a voxel of its own,
/// in that order. Coordinates are multiplied by `unit`, as are those of `whole`, the plan of the
/// cloud that the points are part of.
VoxelPyramid make_pyramid(std::span<const Vec3> positions, std::span<const Vec3> normals,
                          std::span<const std::uint32_t> order, double unit,
                          const PyramidPlan* whole = nullptr);

struct LevelOptions {
  double eps = 0.1;
  bool gated = false;                  ///< the sums will depend on the direction of each normal
  const PyramidPlan* whole = nullptr;  ///< decides which levels exist, and how they merge
};

/// Makes the levels above the first, anew if there are some, so that scale t reads voxels of cells
/// of edge at most eps t; a level that would merge next to nothing is left out, and the scale reads
/// the preceding finer level.
///
/// See merge_voxels() for the rule. Where the average neighbourhood is filled with leaves or noise
/// rather than crossed by surfaces, these are merged further, so that it costs about as much as
/// elsewhere. `scales` must be positive and ascending. Work and memory are linear in the points:
/// together the levels hold about two and a half voxels per point.
void make_levels(VoxelPyramid& pyramid, std::span<const double> scales, const LevelOptions& options,
                 const Progress* progress = nullptr);

}  // namespace pcednet::gls
