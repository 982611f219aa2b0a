#pragma once

#include <span>
#include <vector>

#include "pcednet/core/progress.h"
#include "pcednet/detect/model.h"
#include "pcednet/detect/points/prepare.h"
#include "pcednet/tiles/plan.h"
#include "pcednet/tiles/sample.h"

namespace pcednet::tiles {

/// All points of some cubes, with all their neighbours, or all points of the cloud with a place.
struct DenseSample {
  PointCloud cloud = {};  ///< positions and normals only
  bool is_all = false;
  std::vector<BoundingBox> cubes = {};  ///< none if it is all
  double share = 1.0;  ///< of the points that were read: fewer where they are thinned
};

/// All points where the sample holds all; the cubes are around positions of the sample. Of results
/// that lost their comments, the plan learns whether their normals are estimates.
DenseSample read_dense_sample(const SampledPoints& sample, Plan& plan, const Progress* progress);

/// Why a sample has fewer points than were read.
struct Thinning {
  detect::Averaging averaging = {};
  bool poles = false;
};

/// Puts averages in place of points in thick noise, or leaves out crowds at the poles of scanners,
/// as prepare() does with average_noise for a cloud in memory, and notes it.
Thinning thin(const detect::PrepareOptions& options, DenseSample& dense, Plan& plan,
              const Progress* progress);

/// A dense sample, ready for description. It must outlive this.
struct PreparedSample {
  std::span<const Vec3> positions = {}, normals = {};
  std::vector<std::uint32_t> curve = {};    ///< of the positions
  std::vector<Vec3> moved = {}, made = {};  ///< unless they are the sample's own
  bool is_all = false;
};

/// Makes, from a dense sample, the decisions on normals that prepare() makes for a cloud in memory;
/// where many points have no normals, a part of them decides. The plan must have its box. The notes
/// of prepare() go to the plan's, for the user.
PreparedSample decide_normals(const DenseSample& dense, const detect::PrepareOptions& options,
                              Plan& plan, const Progress* progress);

/// The decisions on voxels, as the fast engine makes them. The plan must have its scales.
void decide_voxels(const PreparedSample& sample, const detect::EdgeModel& model, Plan& plan,
                   const Progress* progress);

}  // namespace pcednet::tiles
