#pragma once

#include <span>
#include <vector>

#include "pcednet/core/progress.h"
#include "pcednet/detect/model.h"
#include "pcednet/tiles/plan.h"

namespace pcednet::tiles {

/// All points of some cubes, with all their neighbours, or all points of the cloud where `sample`
/// holds all. Positions and normals only; the cubes are around positions of the sample, which is in
/// curve order.
PointCloud read_dense_sample(std::span<const Vec3> sample, const Plan& plan,
                             const Progress* progress);

/// Makes, from a dense sample, the decisions that depend on all points of a cloud: on normals and
/// voxels as prepare() and the fast engine make them for a cloud in memory; where many points have
/// no normals, a part of them decides on their estimation. The plan must have its box and scales.
/// The notes of prepare() go to the plan's, for the user.
void decide(const PointCloud& dense, const detect::EdgeModel& model,
            const detect::PrepareOptions& options, Plan& plan, const Progress* progress);

}  // namespace pcednet::tiles
