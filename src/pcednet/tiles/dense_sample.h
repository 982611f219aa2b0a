#pragma once

#include <span>
#include <vector>

#include "pcednet/core/progress.h"
#include "pcednet/detect/model.h"
#include "pcednet/detect/prepare.h"
#include "pcednet/tiles/plan.h"

namespace pcednet::tiles {

/// All points of some cubes, with all their neighbours, or all points of the cloud where `sample`
/// holds all. Positions and normals only; the cubes are around positions of the sample, which is in
/// curve order.
PointCloud read_dense_sample(std::span<const Vec3> sample, const Plan& plan,
                             const Progress* progress);

/// A dense sample, ready for description. It must outlive this.
struct PreparedSample {
  std::span<const Vec3> positions, normals;
  std::vector<std::uint32_t> curve;  ///< of the positions
  std::vector<Vec3> moved, made;     ///< unless they are the sample's own
};

/// Makes, from a dense sample, the decisions on normals that prepare() makes for a cloud in memory;
/// where many points have no normals, a part of them decides. The plan must have its box. The notes
/// of prepare() go to the plan's, for the user.
PreparedSample decide_normals(const PointCloud& dense, const detect::PrepareOptions& options,
                              Plan& plan, const Progress* progress);

/// The decisions on voxels, as the fast engine makes them. The plan must have its scales.
void decide_voxels(const PreparedSample& sample, const detect::EdgeModel& model, Plan& plan,
                   const Progress* progress);

}  // namespace pcednet::tiles
