#pragma once

#include <span>
#include <vector>

#include "pcednet/core/progress.h"
#include "pcednet/detect/model.h"
#include "pcednet/tiles/plan.h"

namespace pcednet::tiles {

/// The points of some cubes, with all their neighbours, or all points where `sample` holds all.
/// Positions and normals only; the cubes are around positions of the sample, which is in curve
/// order.
PointCloud read_dense_sample(std::span<const Vec3> sample, const Plan& plan,
                             const Progress* progress);

/// Decides from a dense sample what all points of a cloud together decide: of the normals and of
/// the voxels, as prepare() and the fast engine do it for a cloud in memory; but where many points
/// have no normals, from a part of them, how these are estimated. The plan must have its box and
/// scales. What prepare() notes is for the user.
void decide(const PointCloud& dense, const detect::EdgeModel& model,
            const detect::PrepareOptions& options, Plan& plan, const Progress* progress);

}  // namespace pcednet::tiles
