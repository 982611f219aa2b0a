#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "pcednet/core/progress.h"
#include "pcednet/gls/engine/lane_kernels.h"
#include "pcednet/gls/engine/voxel_pyramid.h"
#include "pcednet/gls/fit_status.h"
#include "pcednet/gls/oriented_points.h"
#include "pcednet/gls/scales.h"

namespace pcednet::gls {

/// The scale-space matrix of a cloud at a cost per point that depends neither on the size of the
/// cloud nor on s_max.
///
/// Scale t reads the cloud from voxels of edge at most eps t (see VoxelPyramid), in single
/// precision, for 16 points at a time. Where nothing is merged yet (the nearest scales) it agrees
/// with ExactScaleSpace to float rounding, statuses included; docs/engine.md quantifies the
/// agreement elsewhere. Fits that float cannot resolve are repeated in double precision.
///
/// Reconstructs with algebraic spheres only. All results are the same bits for any numbering of the
/// points, any number of threads and any choice of targets, and never NaN or infinite; a flip of
/// all normals negates every feature but phi exactly (unless points with opposite normals
/// coincide).
class FastScaleSpace {
 public:
  /// Copies what it needs of `points`, 80 to 140 bytes each. Throws as check() does, Error(kUsage)
  /// for a reconstruction with planes, and Error(kInsufficient) for clouds without a range of
  /// scales (see scale_range()).
  FastScaleSpace(OrientedPoints points, const ScaleSpaceOptions& options,
                 const Progress* progress = nullptr);

  /// The same with the given vector code; all agree to float rounding.
  FastScaleSpace(OrientedPoints points, const ScaleSpaceOptions& options,
                 const LaneKernels& kernels, const Progress* progress = nullptr);

  const ScaleSpaceOptions& options() const { return options_; }

  /// The support radii, smallest first; of several octaves, those of the first, or those of the one
  /// taken since.
  const std::vector<double>& scales() const { return scales_; }
  const ScaleRange& range() const { return range_; }

  /// Changes to the scales of an octave, below the octave_count() of the range. `whole` is as in
  /// OrientedPoints. Not while others describe.
  void take_octave(std::size_t octave, const PyramidPlan* whole = nullptr,
                   const Progress* progress = nullptr);

  /// The plan of the voxels that these points decided; for a part of a cloud, the plan of the
  /// whole.
  PyramidPlan pyramid_plan() const;

  /// The finite points in the most efficient order of targets: along a curve, so that each run of
  /// 4096 that starts at a multiple of 4096 is evaluated together. Fewer than 16 at a time cost as
  /// much as 16.
  std::span<const std::uint32_t> order() const { return order_; }

  /// Describes the points numbered `targets`, on all threads. `out` is targets x scales x
  /// column_count() numbers, `status` targets x scales; with two gates a status is the worse of
  /// both. A point that is not finite is undefined at every scale. May be called from many threads.
  /// Throws Error(kUsage) if a target or a size is wrong.
  void describe(std::span<const std::uint32_t> targets, std::span<float> out,
                std::span<FitStatus> status, const Progress* progress = nullptr) const;

 private:
  void find_range(OrientedPoints points, std::span<const std::uint32_t> curve,
                  bool may_share_places);
  void take_scales(const ScaleRange& range, const PyramidPlan* whole, const Progress* progress);
  void describe_block(std::span<const Visit> visits, std::span<float> out,
                      std::span<FitStatus> status) const;

  ScaleSpaceOptions options_;
  const LaneKernels* kernels_;
  std::vector<std::uint32_t> order_, place_;
  std::size_t places_ = 0;  ///< copies of a point share one
  double unit_ = 1.0;       ///< the factor of the pyramid's coordinates, a power of two
  VoxelPyramid pyramid_;
  ScaleRange range_;
  std::vector<double> scales_;
};

}  // namespace pcednet::gls
