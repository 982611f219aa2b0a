#pragma once

#include <vector>

#include "pcednet/gls/voxel_pyramid.h"

namespace pcednet::gls {

/// The voxels of `from` merged into cells of edge `cell` that start at `origin`, along the curve
/// through the cells; one voxel per cell, dominant axis of the normal and sign. Coordinates are at
/// least those of `origin` and at most `side` more.
std::vector<Voxel> merge_voxels(const std::vector<Voxel>& from, const Vec3& origin, double side,
                                double cell);

/// How many voxels of `from` would go into the same voxel as the average point's: 1 where nothing
/// would merge. Estimated from every sixteenth stretch of the curve.
double mean_merge(const std::vector<Voxel>& from, const Vec3& origin, double cell);

}  // namespace pcednet::gls
