#pragma once

#include "pcednet/gls/engine/voxel_pyramid.h"

namespace pcednet::gls {

/// The cells that voxels are merged into. Coordinates are at least those of `origin` and at most
/// `side` more.
struct MergeCells {
  Vec3 origin;
  double side;
  double edge;
  Crowd crowd;
};

/// The voxels of `from` merged, along the curve through the cells: one voxel per cell, dominant
/// axis of the normal and sign, so that none averages across an edge; for exceptions see Crowd.
VoxelArray merge_voxels(VoxelSpan from, const MergeCells& cells);

/// The effect of merge_voxels() on the average point, estimated from every sixteenth range of the
/// curve; from all ranges where there are more than 2^20 cells along an axis.
struct MergeForecast {
  double merged = 1.0;  ///< voxels of `from` in its merged voxel; 1 if nothing would merge
  /// With Crowd::kKeep: occupied cells of its block times NormalSpread::mean_sq_volume(), at most 6
  /// on scans of surfaces, 20 or more on noise.
  double filling = 0.0;
};
MergeForecast forecast_merge(VoxelSpan from, const MergeCells& cells);

/// At least about MergeForecast::merged, from short pieces of all ranges: clumps count wherever
/// they are.
double least_merged(VoxelSpan from, const MergeCells& cells);

}  // namespace pcednet::gls
